#include "proto/detail/simplified_draco.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "papilio/error.h"
#include "proto/detail/base_coder.h"
#include "proto/detail/packed_writer.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"

namespace papilio::proto::detail {
namespace {

constexpr Limits no_limits{face_count_limit, face_count_limit, face_count_limit};

/// Coder of several meshes, which keeps the smallest stream of each.
class SmallestDraco {
 public:
  CodedBase code(const TriangleMesh& triangles, const PositionGrid& grid) {
    const Mesh mesh = build_mesh(triangles);
    const QuantizationBox box{grid.origin, grid.step * static_cast<float>((1 << grid.bits) - 1)};
    std::string smallest;
    for (const int speed : {0, 3}) {
      std::string stream = write_draco(mesh, box, {.position_bits = grid.bits, .speed = speed});
      if (smallest.empty() || stream.size() < smallest.size()) smallest = std::move(stream);
    }
    CodedBase coded{read_draco(smallest, no_limits), smallest.size()};
    streams_.emplace_back(grid, std::move(smallest));
    return coded;
  }

  [[nodiscard]] const std::string& stream_of(const SimplifiedDetail& made) const {
    for (const auto& [grid, stream] : streams_)
      if (grid == made.grid && stream.size() == made.bytes &&
          static_cast<const TriangleMesh&>(read_draco(stream, no_limits)) == made.triangles)
        return stream;
    throw std::logic_error("stream_of: this mesh was not coded here");
  }

 private:
  std::vector<std::pair<PositionGrid, std::string>> streams_;
};

}  // namespace

std::optional<SimplifiedDraco> write_simplified_draco(const TriangleMesh& original, const SimplifyOptions& options,
                                                      NormalStyle normals, const gltf::Materials& materials) {
  SmallestDraco coder;
  const std::optional<SimplifiedDetail> made = simplify_detail(
      original, options, [&](const TriangleMesh& mesh, const PositionGrid& grid) { return coder.code(mesh, grid); });
  if (!made) return std::nullopt;
  SimplifiedDraco simplified{.glb = write_plain(made->triangles, {coder.stream_of(*made)}, normals, materials),
                             .faces = made->triangles.triangles.size(),
                             .position_bits = made->grid.bits,
                             .reach = made->reach};
  simplified.bytes = simplified.glb.size();
  return simplified;
}

}  // namespace papilio::proto::detail
