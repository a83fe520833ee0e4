#include "proto/detail/base_coder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
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

/// Bounds of the moves of vertices, lengths: across the surface, and in all. A vertex without a normal moves by at most
/// `across` in all.
struct MostMove {
  double across = 0, slide = 0;
};

/// Places vertices on a grid, each on a point of its own.
class GridPlaces {
 public:
  GridPlaces(const Grid& grid, MostMove most) : grid_(grid), most_(most) {}

  /// Returns, of the free grid points around a position on a surface with a unit normal, the one nearest across the
  /// surface: along it, any serves. Without a normal (zero), the nearest. Nothing if none is within the bounds.
  std::optional<Vec3f> take(Vec3f position, Vec3d normal) {
    const bool slides = normal != Vec3d{};
    const Vec3d origin = to_double(grid_.box.origin);
    const Vec3d from = to_double(position) - origin;
    const double step = grid_.step();
    // Calls visit(i) for the numbers of the grid lines around a coordinate.
    const auto for_each_line = [&](double coordinate, const auto& visit) {
      const auto nearest = static_cast<int>(std::lround(coordinate / step));
      const int last = std::min(nearest + cells_around, grid_.last());
      for (int i = std::max(nearest - cells_around, 0); i <= last; ++i) visit(i);
    };
    double least = std::numeric_limits<double>::infinity();
    std::array<int, 3> best{};
    for_each_line(from.x, [&](int i) {
      for_each_line(from.y, [&](int j) {
        for_each_line(from.z, [&](int k) {
          const Vec3d move = step * Vec3d{double(i), double(j), double(k)} - from;
          const double far = length(move), across = slides ? std::abs(dot(move, normal)) : far;
          const double cost = across + weight_of_slide * far;
          if (across > most_.across || (slides && far > most_.slide) || cost >= least || taken_.contains({i, j, k}))
            return;
          least = cost;
          best = {i, j, k};
        });
      });
    });
    if (!std::isfinite(least)) return std::nullopt;
    taken_.insert(best);
    return to_float(origin + step * Vec3d{double(best[0]), double(best[1]), double(best[2])});
  }

 private:
  Grid grid_;
  MostMove most_;
  std::set<std::array<int, 3>> taken_;
};

/// Returns the positions moved onto the grid, each to a point of its own. Nothing if the grid is too coarse for the
/// bounds.
std::optional<Buffer<Vec3f>> move_onto(const Grid& grid, Buffer<Vec3f> positions, const std::vector<Vec3d>& normals,
                                       MostMove most) {
  GridPlaces places(grid, most);
  for (size_t v = 0; v < positions.size(); ++v) {
    const std::optional<Vec3f> place = places.take(positions[v], normals[v]);
    if (!place) return std::nullopt;
    positions[v] = *place;
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
  return found.isolated_points + found.degenerate_faces + found.repeated_faces == 0;
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
  for (int bits = fewest_position_bits;; ++bits) {
    std::optional<Buffer<Vec3f>> moved = move_onto({box, bits}, mesh.positions, normal_of, {most_move_, most_slide_});
    if (!moved && bits < most_position_bits) continue;
    Mesh rounded = mesh;
    if (moved) rounded.positions = std::move(*moved);
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
    CodedBase coded{coded_.back().decoded, coded_.back().bytes(), base.positions};
    for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
      coded.moved[base.triangles[h / 3][h % 3]] = rounded.positions[mesh.topology.origin[h]];
    return coded;
  }
}

const std::vector<std::string>& DracoBaseCoder::streams_of(const TriangleMesh& decoded) const {
  for (const PartStreams& coded : coded_)
    if (coded.decoded == decoded) return coded.streams;
  throw std::logic_error("streams_of: this base was not coded here");
}

}  // namespace papilio::proto::detail
