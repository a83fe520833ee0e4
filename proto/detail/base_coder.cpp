#include "proto/detail/base_coder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "papilio/error.h"
#include "proto/problem.h"
#include "proto/quantization_box.h"

namespace papilio::proto::detail {
namespace {

double longest_side(const Box& box) {
  const Vec3d size = to_double(box.max) - to_double(box.min);
  return std::max({size.x, size.y, size.z});
}

double shortest_edge(const Mesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    shortest = std::min(shortest, length(to_double(mesh.positions[mesh.topology.tip(h)]) -
                                         to_double(mesh.positions[mesh.topology.origin[h]])));
  return shortest;
}

/// Returns whether a decoded base has all vertices and faces of the original base, with distinct positions.
bool keeps_surface(const Mesh& base, const TriangleMesh& decoded) {
  if (decoded.triangles.size() != base.topology.face_count()) return false;
  BuildReport found;
  try {
    if (build_mesh(decoded, &found).topology.vertex_count != base.topology.vertex_count) return false;
  } catch (const Error& error) {
    if (error.fault() != Fault::no_faces) throw;
    return false;
  }
  const uint32_t welded = decoded.attributes.empty() ? found.welded_points : 0;  // points on seams are welded
  return welded + found.isolated_points + found.degenerate_faces + found.repeated_faces == 0;
}

}  // namespace

QuantizationBox tight_box(const Box& box) {
  const double range = longest_side(box);
  if (!(range >= least_range))
    throw Problem(Code::mesh_unusable, "The extent of the mesh is below 1e-30. Scale it up.");
  return {box.min, std::nextafter(static_cast<float>(range), std::numeric_limits<float>::infinity())};
}

double tight_grid_distance(const Box& box, int position_bits) {
  return 0.5 * std::sqrt(3.0) * longest_side(box) / ((1 << position_bits) - 1);
}

CodedBase DracoBaseCoder::code(const TriangleMesh& base) {
  const Mesh mesh = build_mesh(base);
  const Box box = bounding_box(mesh.positions);
  const double most_move = std::min(most_move_, 0.5 * shortest_edge(mesh));
  int bits = fewest_position_bits;
  while (bits < most_position_bits && tight_grid_distance(box, bits) > most_move) ++bits;
  for (;; ++bits) {
    std::optional<PartStreams> smallest;
    for (const int speed : {0, 3}) {
      PartStreams coded = write_parts(mesh, {.position_bits = bits, .speed = speed});
      if (keeps_surface(mesh, coded.decoded) && (!smallest || coded.bytes() < smallest->bytes()))
        smallest = std::move(coded);
    }
    if (!smallest && bits < most_position_bits) continue;
    if (!smallest)
      throw Error(Fault::bad_surface, "Vertices of the base are too close to each other for a grid of " +
                                          std::to_string(most_position_bits) + " bits. Remove slivers.");
    coded_.push_back(std::move(*smallest));
    return {coded_.back().decoded, coded_.back().bytes()};
  }
}

const std::vector<std::string>& DracoBaseCoder::streams_of(const TriangleMesh& decoded) const {
  for (const PartStreams& coded : coded_)
    if (coded.decoded == decoded) return coded.streams;
  throw std::logic_error("streams_of: this base was not coded here");
}

}  // namespace papilio::proto::detail
