#pragma once

#include <span>
#include <string>
#include <vector>

#include "papilio/detail.h"
#include "proto/detail/part_streams.h"
#include "proto/quantization_box.h"

namespace papilio::proto::detail {

/// Bits of a coordinate on the grids of bases and plain Draco files.
inline constexpr int fewest_position_bits = 6, most_position_bits = 20;

/// Returns the cube at the lowest corner of a bounding box, as wide as its longest side. It has no padding: a base,
/// unlike a mesh to refine, has no vertex outside its box. Throws `Problem` mesh_unusable for a mesh smaller than
/// 1e-30.
[[nodiscard]] QuantizationBox tight_box(const Box& box);

/// Returns the largest distance by which a grid of `position_bits` in the `tight_box` moves a position.
[[nodiscard]] double tight_grid_distance(const Box& box, int position_bits);

/// Coder of bases by Draco, with the fewest bits of a coordinate that give every vertex a grid point of its own and
/// move none by more than `most_move`, a length, or across its surface by that and in all by `most_slide`. Tries the
/// speeds 0 and 3 and takes the smaller stream: for few vertices often 3, by 2 to 9 %.
class DracoBaseCoder {
 public:
  explicit DracoBaseCoder(double most_move, double most_slide = 0) : most_move_(most_move), most_slide_(most_slide) {}

  /// Codes a base, decodes it as read_packed() does, and keeps its streams. `normals` [V]: unit normals where vertices
  /// may slide, else zero; empty: none slides. Throws `Problem`, errors of build_mesh(), and `Error` bad_surface if the
  /// finest grid welds vertices.
  [[nodiscard]] CodedBase code(const TriangleMesh& base, std::span<const Vec3d> normals = {});

  /// Returns the streams, one for each part, of a base that code() returned. Throws `std::logic_error` for another
  /// base.
  [[nodiscard]] const std::vector<std::string>& streams_of(const TriangleMesh& decoded) const;

 private:
  double most_move_, most_slide_;
  std::vector<PartStreams> coded_;
};

}  // namespace papilio::proto::detail
