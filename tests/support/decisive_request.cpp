#include "tests/support/decisive_request.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/shapes.h"

namespace papilio::test {
namespace {

uint32_t below(std::mt19937& random, uint32_t bound) { return static_cast<uint32_t>(random() % bound); }
bool one_in(std::mt19937& random, uint32_t times) { return below(random, times) == 0; }
double between(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}
double of_any_size(std::mt19937& random, double low, double high) {
  return low * std::pow(high / low, between(random, 0, 1));
}
Vec3d vector(std::mt19937& random, double most) {
  const double x = between(random, -most, most);
  const double y = between(random, -most, most);
  return {x, y, between(random, -most, most)};
}

TriangleMesh shape(std::mt19937& random) {
  switch (below(random, 9)) {
    case 0:
      return icosahedron();
    case 1:
      return octahedron();
    case 2:
      return torus(3 + below(random, 4), 3 + below(random, 4));
    case 3:
      return grid(1 + below(random, 5), 1 + below(random, 5));
    case 4:
      return bipyramid(one_in(random, 4) ? 32 + below(random, 4) : 3 + below(random, 7));
    case 5:
      return fan(1 + below(random, 8), false);
    case 6:
      return box({1 + below(random, 2), 1 + below(random, 2), 1 + below(random, 2)}, {1, 1, 1.5F});
    case 7:
      return square_ring(3 + below(random, 4), 1, 1.5F, 0.5F);
    default:
      return random_manifold(random);
  }
}

/// Removes faces, reverses one, adds some at existing edges, and merges two points; each in some cases.
void spoil(std::mt19937& random, TriangleMesh& mesh) {
  const auto any_face = [&] { return below(random, static_cast<uint32_t>(mesh.triangles.size())); };
  const auto any_point = [&] { return below(random, static_cast<uint32_t>(mesh.positions.size())); };
  if (one_in(random, 3) && mesh.triangles.size() > 4)
    for (int i = 0; i < 2; ++i) {
      const uint32_t face = any_face();
      std::copy(mesh.triangles.begin() + face + 1, mesh.triangles.end(), mesh.triangles.begin() + face);
      mesh.triangles.pop_back();
    }
  if (one_in(random, 4)) {
    Triangle& turned = mesh.triangles[any_face()];
    std::swap(turned[0], turned[1]);
  }
  for (uint32_t left = one_in(random, 4) ? 1 + below(random, 3) : 0; left > 0; --left) {
    const auto& [a, b, c] = mesh.triangles[any_face()];
    const auto point = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back(mesh.positions[a] + to_float(vector(random, 1)));
    mesh.triangles.push_back({b, a, point});
  }
  if (one_in(random, 4) && mesh.triangles.size() > 4) mesh.positions[any_point()] = mesh.positions[any_point()];
}

/// Returns whether two faces share all three vertices.
bool has_doubled_faces(const TriangleMesh& mesh) {
  std::set<Triangle> known;
  for (Triangle t : build_mesh(mesh).triangles().triangles) {
    std::ranges::sort(t);
    if (!known.insert(t).second) return true;
  }
  return false;
}

View decisive_view(std::mt19937& random, const Mesh& mesh) {
  const Box box = bounding_box(mesh.positions);
  const double size = box.diagonal();
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max)) + vector(random, 0.3 * size);
  view.eye = view.target + of_any_size(random, 0.3, 2) * size * vector(random, 1);
  view.up = vector(random, 1);
  view.fov_y = between(random, 20, 80);
  view.viewport = {between(random, 300, 1500), between(random, 300, 1500)};
  const double distance = length(view.target - view.eye);
  if (one_in(random, 3)) view.near = between(random, 0.3, 1.2) * distance;
  if (one_in(random, 2)) view.projection = Projection::orthographic;
  const double pixels = view.viewport[1] * size / (2 * std::tan(view.fov_y / 360 * 3.14159265358979) * distance);
  view.edge_pixels = one_in(random, 2) ? of_any_size(random, 0.03, 0.6) * pixels : 0;
  view.error_pixels = one_in(random, 2) ? of_any_size(random, 1e-3, 3e-2) * pixels : 0;
  if (one_in(random, 3))
    for (uint32_t left = 1 + below(random, 3); left > 0; --left) view.lights.push_back(vector(random, 1));
  return view;
}

}  // namespace

void jitter(std::mt19937& random, double share, TriangleMesh& mesh) {
  const double size = bounding_box(mesh.positions).diagonal();
  for (Vec3f& p : mesh.positions) p += to_float(vector(random, share * size));
}

TriangleMesh jittered_mesh(std::mt19937& random) {
  while (true) {
    TriangleMesh mesh = shape(random);
    jitter(random, of_any_size(random, 0.005, 0.08), mesh);
    if (one_in(random, 2)) spoil(random, mesh);
    const auto scale = static_cast<float>(of_any_size(random, 1e-2, 1e2));
    const Vec3f place = to_float(vector(random, scale));
    for (Vec3f& p : mesh.positions) p = scale * p + place;
    if (!has_doubled_faces(mesh)) return mesh;
  }
}

Options decisive_request(std::mt19937& random, const Mesh& mesh, uint64_t most_faces) {
  const uint64_t faces = mesh.topology.face_count();
  Options options;
  options.levels = static_cast<int>(below(random, 9) + 3) / 3 - (one_in(random, 12) ? 1 : 0);
  while (options.levels > 0 && faces << 2U * options.levels > most_faces) --options.levels;
  options.scheme = one_in(random, 3) ? Scheme::in_place : Scheme::red_green;
  options.tension = static_cast<Tension>(below(random, 3));
  options.shape = Shape::plain;
  options.w = one_in(random, 4) ? between(random, -0.0625, 0.125) : 0;
  options.crease_angle = one_in(random, 3) ? between(random, 10, 90) : 180;
  options.growth = static_cast<Growth>(below(random, 3));
  if (one_in(random, 2))
    for (uint32_t left = 1 + below(random, 3); left > 0; --left)
      options.flatness.push_back(between(random, one_in(random, 2) ? 0.9 : 0.3, 1));
  if (one_in(random, 3)) options.tolerance = of_any_size(random, 1e-3, 3e-2);
  if (one_in(random, 2)) options.view = decisive_view(random, mesh);
  if (one_in(random, 3)) options.max_faces = faces + static_cast<uint64_t>(between(random, 0, 5) * double(faces));
  return options;
}

}  // namespace papilio::test
