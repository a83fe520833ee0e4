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
  CodedBase code(const TriangleMesh& triangles, int bits) {
    const Mesh mesh = build_mesh(triangles);
    const QuantizationBox grid = tight_box(bounding_box(mesh.positions));
    std::string smallest;
    for (const int speed : {0, 3}) {
      std::string stream = write_draco(mesh, grid, {.position_bits = bits, .speed = speed});
      if (smallest.empty() || stream.size() < smallest.size()) smallest = std::move(stream);
    }
    CodedBase coded{read_draco(smallest, no_limits), smallest.size()};
    streams_.emplace_back(bits, std::move(smallest));
    return coded;
  }

  [[nodiscard]] const std::string& stream_of(const SimplifiedDetail& made) const {
    for (const auto& [bits, stream] : streams_)
      if (bits == made.position_bits && stream.size() == made.bytes &&
          static_cast<const TriangleMesh&>(read_draco(stream, no_limits)) == made.triangles)
        return stream;
    throw std::logic_error("stream_of: this mesh was not coded here");
  }

 private:
  std::vector<std::pair<int, std::string>> streams_;
};

}  // namespace

std::optional<SimplifiedDraco> write_simplified_draco(const TriangleMesh& original, const SimplifyOptions& options,
                                                      NormalStyle normals) {
  SmallestDraco coder;
  const std::optional<SimplifiedDetail> made =
      simplify_detail(original, options, [&](const TriangleMesh& mesh, int bits) { return coder.code(mesh, bits); });
  if (!made) return std::nullopt;
  SimplifiedDraco simplified{.glb = write_plain(made->triangles, {coder.stream_of(*made)}, normals),
                             .faces = made->triangles.triangles.size(),
                             .position_bits = made->position_bits,
                             .reach = made->reach};
  simplified.bytes = simplified.glb.size();
  return simplified;
}

}  // namespace papilio::proto::detail
