#include "tests/support/random_request.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/trigonometry.h"
#include "core/criteria/camera.h"
#include "papilio/error.h"
#include "tests/support/shapes.h"

namespace papilio::test {
namespace {

class Dice {
 public:
  explicit Dice(std::mt19937& random) : random_(random) {}

  /// Returns true with probability 1 / `times`.
  [[nodiscard]] bool one_in(uint32_t times) { return below(times) == 0; }
  [[nodiscard]] uint32_t below(uint32_t bound) { return static_cast<uint32_t>(random_() % bound); }
  [[nodiscard]] double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  /// Returns a number between the two, uniform in its logarithm.
  [[nodiscard]] double of_any_size(double low, double high) { return low * std::pow(high / low, between(0, 1)); }
  [[nodiscard]] Vec3d vector(double most = 1) {
    const double x = between(-most, most);
    const double y = between(-most, most);
    return {x, y, between(-most, most)};
  }
  template <class Number, size_t count>
  [[nodiscard]] Number one_of(const std::array<Number, count>& numbers) {
    return numbers[below(count)];
  }

 private:
  std::mt19937& random_;
};

/// Three faces at each edge of a line, and two pinched vertices.
TriangleMesh book() {
  return {{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 0}, {1, 0, 2}, {0, 1, 1}, {-1, -1, 1}},
          {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {0, 1, 5}, {1, 2, 5}, {1, 0, 6}, {2, 1, 6}}};
}

TriangleMesh shape(Dice& dice) {
  switch (dice.below(9)) {
    case 0:
      return icosahedron();
    case 1:
      return torus(3 + dice.below(6), 3 + dice.below(6));
    case 2:
      return grid(1 + dice.below(5), 1 + dice.below(5));
    case 3:
      return bipyramid(3 + dice.below(dice.one_in(4) ? 60 : 9));
    case 4:
      return fan(1 + dice.below(9), false);
    case 5:
      return box({1 + dice.below(2), 1 + dice.below(2), 1 + dice.below(3)}, {1, 2, 3});
    case 6:
      return square_ring(3 + dice.below(5), 1, 1.5F, 0.5F);
    case 7:
      return book();
    default:
      return torus(8, 8);
  }
}

View choose_view(Dice& dice, const Mesh& mesh) {
  const Box box = bounding_box(mesh.positions);
  const double size = box.diagonal();
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  if (dice.one_in(3)) view.target += dice.vector(size);
  const double distance = dice.one_in(3) ? dice.of_any_size(1e-9, 1e3) : dice.between(0.1, 2);
  Vec3d direction = dice.vector();
  if (dice.one_in(4)) direction = {0, 0, 1};  // along an axis many edges have equal lengths in pixels
  view.eye = view.target + (distance * size / std::max(length(direction), 1e-3)) * direction;
  view.up = dice.one_in(2) ? Vec3d{0, 1, 0} : dice.vector();
  view.fov_y = dice.one_in(4) ? dice.of_any_size(0.01, 179) : dice.between(10, 90);
  if (dice.one_in(3)) view.viewport = {dice.of_any_size(1, 1e6), dice.of_any_size(1, 1e6)};
  if (dice.one_in(3)) view.near = dice.of_any_size(1e-6, 2) * size;
  view.edge_pixels = dice.one_in(3) ? dice.of_any_size(1e-2, 1e6) : 0;
  if (dice.one_in(2)) {
    // Down to deviations that are only rounding errors.
    const double pixels_per_unit = view.viewport[1] / (2 * tangent_of_degrees(view.fov_y / 2) * distance * size);
    view.error_pixels = dice.of_any_size(1e-18, 1e-1) * size * pixels_per_unit;
  }
  view.projection = dice.one_in(2) ? Projection::perspective : Projection::orthographic;
  if (dice.one_in(2))
    for (uint32_t left = 1 + dice.below(3); left > 0; --left) view.lights.push_back(dice.vector());
  return view;
}

bool is_camera(const View& view) {
  try {
    (void)Camera(view);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

TriangleMesh random_small_mesh(std::mt19937& random) {
  Dice dice(random);
  TriangleMesh mesh = shape(dice);
  if (dice.one_in(2))
    for (Vec3f& p : mesh.positions) p += to_float(dice.vector(0.1));
  if (dice.one_in(3)) {
    const auto size = static_cast<float>(dice.of_any_size(1e-3, 1e3));
    const Vec3f place = to_float(dice.vector(dice.one_in(2) ? 1e3 : 0));
    for (Vec3f& p : mesh.positions) p = size * p + place;
  }
  return mesh;
}

void choose_rules(std::mt19937& random, Options& options) {
  Dice dice(random);
  options.tension = dice.one_of(std::array{Tension::soft, Tension::off, Tension::off, Tension::sharp});
  options.w = dice.one_in(4) ? dice.between(-0.0625, 0.125) : 0;
  options.crease_angle = dice.one_in(3) ? dice.between(0, 90) : 180;
  options.shape =
      dice.one_of(std::array{Shape::automatic, Shape::automatic, Shape::organic, Shape::mechanical, Shape::plain});
}

void choose_request(std::mt19937& random, const Mesh& mesh, Options& options) {
  Dice dice(random);
  options.levels = static_cast<int>(dice.below(4));
  options.scheme = dice.one_in(8) ? Scheme::in_place : Scheme::red_green;
  options.flatness.clear();
  if (dice.one_in(3))
    for (uint32_t left = 1 + dice.below(3); left > 0; --left) options.flatness.push_back(dice.between(0.3, 1));
  options.growth = static_cast<Growth>(dice.below(3));
  options.tolerance = dice.one_in(3) ? dice.of_any_size(1e-5, 1e-1) : 0;
  options.max_faces =
      dice.one_in(3) ? static_cast<uint64_t>(dice.of_any_size(0.9, 20) * mesh.topology.face_count()) + 1 : 0;
  options.view.reset();
  if (!dice.one_in(4)) {
    View view = choose_view(dice, mesh);
    while (!is_camera(view)) view = choose_view(dice, mesh);
    options.view = view;
  }
  options.simplify_hidden = options.view && dice.one_in(8);
}

}  // namespace papilio::test
