#include "tests/support/detail_baseline.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/detail/optimal_collapse.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"

namespace papilio::test {
namespace {

constexpr int fewest_bits = 8, most_bits = 16;

/// Returns the bounding cube, which is Draco's default grid.
proto::QuantizationBox bounding_cube(const TriangleMesh& mesh) {
  const Box box = bounding_box(mesh.positions);
  const Vec3f size = box.max - box.min;
  return {box.min, std::max({size.x, size.y, size.z})};
}

/// Returns the mesh on the grid, without faces of which two corners are equal there.
Mesh on_grid(TriangleMesh mesh, const proto::QuantizationBox& cube, int bits) {
  const double step = cube.range / (std::exp2(bits) - 1);
  const auto snapped = [&](float value, float origin) {
    return static_cast<float>(origin + step * std::floor((double{value} - origin) / step + 0.5));
  };
  for (Vec3f& p : mesh.positions)
    p = {snapped(p.x, cube.origin.x), snapped(p.y, cube.origin.y), snapped(p.z, cube.origin.z)};
  return build_mesh(mesh);
}

/// RMS move of the surface, as a share of the grid's step: the variance is a twelfth per coordinate of a vertex, and
/// half of that inside a face, as the mean of three vertices.
constexpr double rms_of_step = 0.2;

double grid_rms(const TriangleMesh& mesh, double diagonal, int bits) {
  return 100 / diagonal * rms_of_step * bounding_cube(mesh).range / std::exp2(bits);
}

/// Returns the bits at which both the grid and the collapses contribute to the error.
std::vector<int> fitting_bits(const DetailSubject& subject, const TriangleMesh& mesh, double rms) {
  std::vector<int> bits;
  for (int b = fewest_bits; b <= most_bits; ++b) {
    const double grid = grid_rms(mesh, subject.surface.diagonal(), b);
    const double both = std::hypot(grid, rms);
    if (both < finest_rms / 2 || both > 2 * coarsest_rms) continue;
    if (rms == 0 || (grid > 0.15 * rms && grid < 1.3 * rms)) bits.push_back(b);
  }
  return bits;
}

/// Returns the Draco points of one simplified mesh.
void add_points(const DetailSubject& subject, const TriangleMesh& mesh, std::vector<RatePoint>& points) {
  const double rms =
      mesh.triangles.size() == subject.original.triangles.size() ? 0 : subject.surface.distance_to(mesh).rms;
  for (const int bits : fitting_bits(subject, mesh, rms))
    points.push_back(rate_point(subject, smallest_draco(mesh, bits), bits));
}

TriangleMesh by_meshoptimizer(const TriangleMesh& mesh, size_t faces) {
  TriangleMesh out;
  out.positions = mesh.positions;
  std::vector<uint32_t> indices(3 * mesh.triangles.size());
  const size_t count =
      meshopt_simplify(indices.data(), mesh.triangles.data()->data(), indices.size(), &mesh.positions.data()->x,
                       mesh.positions.size(), sizeof(Vec3f), 3 * faces, 1.0F, 0, nullptr);
  for (size_t i = 0; i < count; i += 3) out.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  return out;
}

}  // namespace

DetailSubject::DetailSubject(std::string subject_name, const TriangleMesh& mesh, size_t samples)
    : name(std::move(subject_name)),
      original(build_mesh({mesh.positions, mesh.triangles}).triangles()),
      surface(original, samples) {}

std::string smallest_draco(const TriangleMesh& mesh, int position_bits) {
  const proto::QuantizationBox cube = bounding_cube(mesh);
  std::vector<Mesh> forms;
  forms.push_back(build_mesh(mesh));
  forms.push_back(on_grid(mesh, cube, position_bits));
  if (forms[0].topology.face_count() == forms[1].topology.face_count()) forms.pop_back();
  std::string smallest;
  for (const Mesh& form : forms)
    for (const int speed : {0, 3}) {
      std::string stream = proto::write_draco(form, cube, {.position_bits = position_bits, .speed = speed});
      if (smallest.empty() || stream.size() < smallest.size()) smallest = std::move(stream);
    }
  return smallest;
}

RatePoint rate_point(const DetailSubject& subject, const std::string& draco, int position_bits) {
  const TriangleMesh arrived = proto::read_draco(draco, {});
  const SampledDistance distance = subject.surface.distance_to(arrived);
  return {.bytes = static_cast<double>(draco.size()),
          .rms = distance.rms,
          .largest = distance.largest,
          .faces = arrived.triangles.size(),
          .bits = position_bits};
}

std::vector<size_t> size_ladder(size_t faces, double ratio, size_t least) {
  std::vector<size_t> sizes;
  for (; faces >= least; faces = static_cast<size_t>(ratio * static_cast<double>(faces))) sizes.push_back(faces);
  return sizes;
}

std::vector<RatePoint> plain_draco(const DetailSubject& subject) {
  std::vector<RatePoint> points;
  for (int bits = fewest_bits; bits <= most_bits; ++bits)
    points.push_back(rate_point(subject, smallest_draco(subject.original, bits), bits));
  return points;
}

std::vector<RatePoint> meshoptimizer_and_draco(const DetailSubject& subject) {
  std::vector<RatePoint> points;
  size_t last = subject.original.triangles.size();
  for (const size_t faces : size_ladder(last)) {
    const TriangleMesh mesh = by_meshoptimizer(subject.original, faces);
    if (mesh.triangles.size() >= last || mesh.triangles.empty()) continue;
    last = mesh.triangles.size();
    add_points(subject, mesh, points);
  }
  return points;
}

std::vector<RatePoint> quadrics_and_draco(const DetailSubject& subject, Quadrics quadrics) {
  std::vector<RatePoint> points;
  const std::vector<size_t> sizes = size_ladder(subject.original.triangles.size());
  for (const TriangleMesh& mesh : collapse_to_sizes(subject.original, sizes, quadrics))
    add_points(subject, mesh, points);
  return points;
}

std::vector<DetailMethod> detail_baselines() {
  const auto quadrics = [](Quadrics kind) {
    return [kind](const DetailSubject& subject) { return quadrics_and_draco(subject, kind); };
  };
  return {{"plain Draco", plain_draco},
          {"meshoptimizer", meshoptimizer_and_draco},
          {"quadrics", quadrics(Quadrics::accumulated)},
          {"memoryless", quadrics(Quadrics::memoryless)}};
}

}  // namespace papilio::test
