#include "server/samples/models.h"

#include <array>
#include <vector>

#include "papilio/trigonometry.h"

namespace papilio::server {
namespace {

/// Corners of a quadrangle, counter-clockwise seen from outside.
using Quad = std::array<uint32_t, 4>;

struct ProfilePoint {
  double radius, height;
};

uint32_t add_vertex(TriangleMesh& mesh, Vec3d position) {
  mesh.positions.push_back(to_float(position));
  return static_cast<uint32_t>(mesh.positions.size() - 1);
}

void add_quad(TriangleMesh& mesh, const Quad& q) {
  mesh.triangles.push_back({q[0], q[1], q[2]});
  mesh.triangles.push_back({q[0], q[2], q[3]});
}

/// Adds the four quadrangles between two rings. Both rings run counter-clockwise seen from beyond `to`.
void add_tube(TriangleMesh& mesh, const Quad& from, const Quad& to) {
  for (uint32_t k = 0; k < 4; ++k) add_quad(mesh, {from[k], from[(k + 1) % 4], to[(k + 1) % 4], to[k]});
}

/// Closed surface of revolution about z. The profile runs from the lower pole to the upper, both not in `rings`, with
/// the outside on its right. is_hole(band, sector) omits quadrangles; band i lies above ring i.
class Lathe {
 public:
  Lathe(TriangleMesh& mesh, uint32_t sectors, double first_pole, const std::vector<ProfilePoint>& rings,
        double last_pole)
      : sectors_(sectors), rings_(static_cast<uint32_t>(rings.size())) {
    first_ = static_cast<uint32_t>(mesh.positions.size());
    for (const ProfilePoint& ring : rings) {
      for (uint32_t sector = 0; sector < sectors; ++sector) {
        // The middle of sector 0 faces along x.
        const auto [sine, cosine] = sine_and_cosine_of_turn(2 * (sector + sectors) - 1, 2 * sectors);
        add_vertex(mesh, {ring.radius * cosine, ring.radius * sine, ring.height});
      }
    }
    first_pole_ = add_vertex(mesh, {0, 0, first_pole});
    last_pole_ = add_vertex(mesh, {0, 0, last_pole});
  }

  [[nodiscard]] Quad quad(uint32_t band, uint32_t sector) const {
    return {at(band, sector), at(band, sector + 1), at(band + 1, sector + 1), at(band + 1, sector)};
  }

  template <class IsHole>
  void add_faces(TriangleMesh& mesh, const IsHole& is_hole) const {
    for (uint32_t sector = 0; sector < sectors_; ++sector) {
      mesh.triangles.push_back({first_pole_, at(0, sector + 1), at(0, sector)});
      for (uint32_t band = 0; band + 1 < rings_; ++band)
        if (!is_hole(band, sector)) add_quad(mesh, quad(band, sector));
      mesh.triangles.push_back({last_pole_, at(rings_ - 1, sector), at(rings_ - 1, sector + 1)});
    }
  }

 private:
  [[nodiscard]] uint32_t at(uint32_t ring, uint32_t sector) const {
    return first_ + ring * sectors_ + sector % sectors_;
  }

  uint32_t sectors_, rings_, first_ = 0, first_pole_ = 0, last_pole_ = 0;
};

/// Adds a closed tyre round z: `sectors` rings of `sides` corners each.
void add_tyre(TriangleMesh& mesh, double radius, double tube, uint32_t sectors, uint32_t sides) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (uint32_t sector = 0; sector < sectors; ++sector) {
    const SineCosine along = sine_and_cosine_of_turn(sector, sectors);
    for (uint32_t side = 0; side < sides; ++side) {
      const SineCosine round = sine_and_cosine_of_turn(side, sides);
      const double distance = radius + tube * round.cosine;
      add_vertex(mesh, {distance * along.cosine, distance * along.sine, tube * round.sine});
    }
  }
  const auto at = [&](uint32_t sector, uint32_t side) { return first + sector % sectors * sides + side % sides; };
  for (uint32_t sector = 0; sector < sectors; ++sector)
    for (uint32_t side = 0; side < sides; ++side)
      add_quad(mesh, {at(sector, side), at(sector + 1, side), at(sector + 1, side + 1), at(sector, side + 1)});
}

/// Adds a handle in the plane y = 0: ten sections of four corners on half an ellipse round (x, 0, z), from the upper
/// hole in the wall to the lower.
void add_handle(TriangleMesh& mesh, const Quad& upper_hole, const Quad& lower_hole) {
  constexpr double x = 3.8;
  constexpr double z = 4.8;
  constexpr double reach = 3;
  constexpr double rise = 2.2;
  constexpr double half_thickness = 0.35;
  constexpr double half_width = 0.55;
  constexpr uint32_t sections = 10;
  Quad previous = upper_hole;
  for (uint32_t s = 1; s <= sections; ++s) {
    const SineCosine from_top = sine_and_cosine_of_turn(s, 2 * (sections + 1));
    const auto corner = [&](double side, double outward) {
      return add_vertex(mesh, {x + (reach + outward * half_thickness) * from_top.sine, side * half_width,
                               z + (rise + outward * half_thickness) * from_top.cosine});
    };
    const Quad section{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
    add_tube(mesh, previous, section);
    previous = section;
  }
  // The handle's upper side ends at the lower edge of the lower hole.
  add_tube(mesh, previous, {lower_hole[3], lower_hole[2], lower_hole[1], lower_hole[0]});
}

/// Adds a box along a direction in the plane z = 0, between two distances from the axis.
void add_spoke(TriangleMesh& mesh, SineCosine direction, double from, double to, double half_width) {
  const Vec3d along{direction.cosine, direction.sine, 0};
  const Vec3d across{-along.y, along.x, 0};
  const auto end = [&](double distance) {
    Quad corners{};
    for (uint32_t k = 0; k < 4; ++k) {
      const double side = k == 1 || k == 2 ? half_width : -half_width;
      const double height = k >= 2 ? half_width : -half_width;
      corners[k] = add_vertex(mesh, distance * along + side * across + Vec3d{0, 0, height});
    }
    return corners;
  };
  const Quad inner = end(from);
  const Quad outer = end(to);
  add_quad(mesh, {inner[3], inner[2], inner[1], inner[0]});
  add_quad(mesh, outer);
  add_tube(mesh, inner, outer);
}

Vec3d unit(Vec3d v) { return (1 / length(v)) * v; }

}  // namespace

TriangleMesh knot() {
  constexpr uint32_t sections = 36;
  constexpr uint32_t sides = 6;
  constexpr double size = 3;
  constexpr double radius = 1.9;
  TriangleMesh mesh;
  for (uint32_t s = 0; s < sections; ++s) {
    const auto [sine, cosine] = sine_and_cosine_of_turn(s, sections);
    const auto [sine2, cosine2] = sine_and_cosine_of_turn(2 * s, sections);
    const auto [sine3, cosine3] = sine_and_cosine_of_turn(3 * s, sections);
    const Vec3d centre{size * (sine + 2 * sine2), size * (cosine - 2 * cosine2), -size * sine3};
    const Vec3d along{cosine + 4 * cosine2, 4 * sine2 - sine, -3 * cosine3};
    const Vec3d bend{-sine - 8 * sine2, 8 * cosine2 - cosine, 9 * sine3};
    const Vec3d binormal = unit(cross(along, bend));
    const Vec3d normal = unit(cross(binormal, along));
    for (uint32_t k = 0; k < sides; ++k) {
      const auto [up, out] = sine_and_cosine_of_turn(k, sides);
      add_vertex(mesh, centre + radius * out * normal + radius * up * binormal);
    }
  }
  for (uint32_t s = 0; s < sections; ++s)
    for (uint32_t k = 0; k < sides; ++k) {
      const uint32_t from = s * sides;
      const uint32_t to = (s + 1) % sections * sides;
      add_quad(mesh, {from + k, from + (k + 1) % sides, to + (k + 1) % sides, to + k});
    }
  return mesh;
}

TriangleMesh mug() {
  constexpr uint32_t sectors = 10;
  constexpr uint32_t lower_band = 2;
  constexpr uint32_t upper_band = 4;
  const std::vector<ProfilePoint> rings{
      {3.5, 0},   {4.0, 0.4}, {4.0, 2.0}, {4.0, 3.2}, {4.0, 6.4}, {4.0, 7.6}, {4.0, 9.3},  // outer wall
      {3.8, 9.5},                                                                          // rim
      {3.6, 9.3}, {3.6, 6.4}, {3.6, 3.4}, {3.6, 1.0}, {3.1, 0.6},                          // inner wall
  };
  TriangleMesh mesh;
  const Lathe lathe(mesh, sectors, 0.1, rings, 0.55);
  lathe.add_faces(
      mesh, [](uint32_t band, uint32_t sector) { return sector == 0 && (band == lower_band || band == upper_band); });
  add_handle(mesh, lathe.quad(upper_band, 0), lathe.quad(lower_band, 0));
  return mesh;
}

TriangleMesh wheel() {
  constexpr uint32_t spokes = 8;
  TriangleMesh mesh;
  add_tyre(mesh, 30, 4, 12, 6);
  const std::vector<ProfilePoint> hub{{3, -5}, {4, -4}, {4, 0}, {4, 4}, {3, 5}};
  Lathe(mesh, 5, -5.5, hub, 5.5).add_faces(mesh, [](uint32_t, uint32_t) { return false; });
  for (uint32_t s = 0; s < spokes; ++s) add_spoke(mesh, sine_and_cosine_of_turn(s, spokes), 2.5, 28, 0.8);
  return mesh;
}

}  // namespace papilio::server
