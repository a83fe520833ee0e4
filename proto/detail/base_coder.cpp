#include "proto/detail/base_coder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "papilio/error.h"
#include "proto/problem.h"
#include "proto/quantization_box.h"

namespace papilio::proto::detail {
namespace {

/// Grid points that are tried around the nearest one, in each direction.
constexpr int cells_around = 2;
/// Weight of the distance from a vertex to its grid point, if it may slide. That across the surface weighs 1.
constexpr double weight_of_slide = 0.02;

/// Grid of positions, as Draco has it.
struct Grid {
  QuantizationBox box;
  int bits = 0;

  [[nodiscard]] int last() const { return (1 << bits) - 1; }
  [[nodiscard]] double step() const { return double{box.range} / last(); }
};

/// Returns, of the grid points around a position on a surface with a unit normal, the one nearest across the surface:
/// along it, any serves. Nothing if none is within `most_move` across the surface and `most_slide` in all.
std::optional<Vec3f> point_on_surface(Vec3f position, Vec3d normal, const Grid& grid, double most_move,
                                      double most_slide) {
  const Vec3d origin = to_double(grid.box.origin);
  const Vec3d from = to_double(position) - origin;
  const double step = grid.step();
  // Calls visit(x) for the grid lines around a coordinate.
  const auto for_each_line = [&](double coordinate, const auto& visit) {
    const auto nearest = static_cast<int>(std::lround(coordinate / step));
    const int last = std::min(nearest + cells_around, grid.last());
    for (int i = std::max(nearest - cells_around, 0); i <= last; ++i) visit(step * i);
  };
  double least = std::numeric_limits<double>::infinity();
  std::optional<Vec3f> best;
  for_each_line(from.x, [&](double x) {
    for_each_line(from.y, [&](double y) {
      for_each_line(from.z, [&](double z) {
        const Vec3d move = Vec3d{x, y, z} - from;
        const double far = length(move), across = std::abs(dot(move, normal));
        const double cost = across + weight_of_slide * far;
        if (across > most_move || far > most_slide || cost >= least) return;
        least = cost;
        best = to_float(origin + Vec3d{x, y, z});
      });
    });
  });
  return best;
}

/// Returns the positions, those of vertices with normals moved onto the grid: Draco rounds the others. Nothing if the
/// grid is too coarse: no vertex may move by more than its `room` [V], nor by more than `most_move` across the surface.
std::optional<Buffer<Vec3f>> slide_onto(const Grid& grid, Buffer<Vec3f> positions, const std::vector<Vec3d>& normals,
                                        const std::vector<double>& room, double most_move, double most_slide) {
  const double rounding = 0.5 * std::sqrt(3.0) * grid.step();
  for (size_t v = 0; v < positions.size(); ++v) {
    const double most = std::min(most_move, room[v]);
    if (dot(normals[v], normals[v]) > 0) {
      const std::optional<Vec3f> point =
          point_on_surface(positions[v], normals[v], grid, most, std::min(most_slide, room[v]));
      if (!point) return std::nullopt;
      positions[v] = *point;
    } else if (rounding > most) {
      return std::nullopt;
    }
  }
  return positions;
}

/// Returns the normals [V] in the order of the mesh that was built of the base.
std::vector<Vec3d> reordered(std::span<const Vec3d> normals, const TriangleMesh& base, const Mesh& mesh) {
  std::vector<Vec3d> by_vertex(mesh.positions.size());
  if (normals.size() != base.positions.size() || mesh.topology.face_count() != base.triangles.size()) return by_vertex;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    by_vertex[mesh.topology.origin[h]] = normals[base.triangles[h / 3][h % 3]];
  return by_vertex;
}

double longest_side(const Box& box) {
  const Vec3d size = to_double(box.max) - to_double(box.min);
  return std::max({size.x, size.y, size.z});
}

/// Returns for each point [V] half the distance to the nearest other one. A point that moves by less is still nearer to
/// where it was than any other.
std::vector<double> rooms(const Buffer<Vec3f>& points) {
  const Box box = bounding_box(points);
  const Vec3d size = to_double(box.max) - to_double(box.min);
  const auto along = [&](uint32_t i) {
    return size.x >= std::max(size.y, size.z) ? points[i].x : size.y >= size.z ? points[i].y : points[i].z;
  };
  std::vector<uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, along);
  std::vector<double> least(points.size(), std::numeric_limits<double>::infinity());
  for (size_t i = 0; i < order.size(); ++i)
    for (size_t j = i + 1; j < order.size(); ++j) {
      const uint32_t a = order[i], b = order[j];
      if (double{along(b)} - double{along(a)} > least[a]) break;
      const double distance = length(to_double(points[b]) - to_double(points[a]));
      least[a] = std::min(least[a], distance);
      least[b] = std::min(least[b], distance);
    }
  for (double& distance : least) distance *= 0.5;
  return least;
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

CodedBase DracoBaseCoder::code(const TriangleMesh& base, std::span<const Vec3d> normals) {
  const Mesh mesh = build_mesh(base);
  const std::vector<Vec3d> normal_of = reordered(normals, base, mesh);
  const QuantizationBox box = tight_box(bounding_box(mesh.positions));
  const std::vector<double> room = rooms(mesh.positions);
  for (int bits = fewest_position_bits;; ++bits) {
    const std::optional<Buffer<Vec3f>> moved =
        slide_onto({box, bits}, mesh.positions, normal_of, room, most_move_, most_slide_);
    if (!moved && bits < most_position_bits) continue;
    Mesh rounded = mesh;
    if (moved) rounded.positions = *moved;
    std::optional<PartStreams> smallest;
    for (const int speed : {0, 3}) {
      PartStreams coded = write_parts(rounded, box, {.position_bits = bits, .speed = speed});
      if (keeps_surface(mesh, coded.decoded) && (!smallest || coded.bytes() < smallest->bytes()))
        smallest = std::move(coded);
    }
    if (!smallest && bits < most_position_bits) continue;
    if (!smallest)
      throw Error(Fault::bad_surface, "Vertices of the base are closer to each other than a grid of " +
                                          std::to_string(most_position_bits) + " bits can part.");
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
