#pragma once

#include <string>
#include <vector>

#include "papilio/detail.h"
#include "proto/detail/part_streams.h"
#include "proto/quantization_box.h"

namespace papilio::proto::detail {

/// Bits of a coordinate on the grids of bases and plain Draco files.
inline constexpr int fewest_position_bits = 6, most_position_bits = 20;

/// Returns the cube at the lowest corner of a bounding box, as wide as its longest side. Nothing is padded: a base,
/// unlike a mesh to refine, has no vertex outside its box. Throws `Problem` mesh_unusable for a mesh smaller than
/// 1e-30.
[[nodiscard]] QuantizationBox tight_box(const Box& box);

/// Largest distance by which the grid of so many bits in `tight_box` moves a position.
[[nodiscard]] double tight_grid_distance(const Box& box, int position_bits);

/// Coder of bases by Draco at speed 0, with the fewest bits of a coordinate, from `fewest_position_bits` on, that keep
/// all vertices apart and move none by more than `most_move`, a length.
class DracoBaseCoder {
 public:
  explicit DracoBaseCoder(double most_move) : most_move_(most_move) {}

  /// Codes a base, decodes it as `read_packed` does, and keeps its streams. Throws `Problem`, `Error` like
  /// `build_mesh`, and bad_surface where the finest grid welds vertices.
  [[nodiscard]] CodedBase code(const TriangleMesh& base);

  /// Returns the streams, one for each part, that decode to this base, which `code` returned. Throws `std::logic_error`
  /// for another.
  [[nodiscard]] const std::vector<std::string>& streams_of(const TriangleMesh& decoded) const;

 private:
  double most_move_;
  std::vector<PartStreams> coded_;
};

}  // namespace papilio::proto::detail
