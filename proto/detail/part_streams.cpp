#include "proto/detail/part_streams.h"

#include <utility>

#include "proto/detail/base_coder.h"
#include "proto/detail/mesh_parts.h"
#include "proto/detail/packed_texcoords.h"
#include "proto/draco_reader.h"

namespace papilio::proto::detail {

uint64_t PartStreams::bytes() const {
  uint64_t sum = 0;
  for (const std::string& stream : streams) sum += stream.size();
  return sum;
}

PartStreams write_parts(const Mesh& mesh, const QuantizationBox& grid, const OutputOptions& options,
                        const std::function<void()>& poll) {
  constexpr Limits no_limits{face_count_limit, face_count_limit, face_count_limit};
  PartStreams made;
  std::vector<MeshPart> decoded;
  const auto write = [&](const Mesh& part, double number) {
    const MeshFormat format = base_format(part.attributes.attributes);
    made.streams.push_back(write_draco(part, grid, options, attribute_encoding(part, format), poll));
    decoded.push_back({number, read_draco(made.streams.back(), no_limits)});
  };
  if (!has_parts(mesh.attributes.attributes)) {
    write(mesh, 0);
  } else {
    for (const MeshPart& part : split_parts(mesh.triangles())) write(build_mesh(part.triangles), part.number);
  }
  made.decoded = join_parts(std::move(decoded));
  return made;
}

}  // namespace papilio::proto::detail
