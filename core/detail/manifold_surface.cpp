#include "detail/manifold_surface.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mesh/fan.h"
#include "papilio/error.h"

namespace papilio {
namespace {

/// Upper bound of the rounds: a moved vertex may land on another, which takes a further round.
constexpr int most_rounds_of_parting = 4;
/// Upper bound of a vertex's move, a share of the way to its neighbours.
constexpr double most_of_way = 0.25;

uint32_t shared_edges(const Topology& t) { return static_cast<uint32_t>(std::ranges::count(t.kind, EdgeKind::shared)); }

/// Returns whether the face lies back to back with a lower-numbered one: they share all edges, as in a two-sided leaf.
/// Mesh coders treat them as two surfaces.
bool is_back(const Topology& t, uint32_t f) {
  const uint32_t* twin = &t.twin[size_t{3} * f];
  return twin[0] != none && twin[1] != none && twin[2] != none && twin[0] / 3 < f && twin[0] / 3 == twin[1] / 3 &&
         twin[1] / 3 == twin[2] / 3;
}

bool needs_parting(const Topology& t) {
  if (shared_edges(t) > 0 || !t.pinched.empty()) return true;
  for (uint32_t f = 0; f < t.face_count(); ++f)
    if (is_back(t, f)) return true;
  return false;
}

/// Separation of the fans of a mesh.
class FanParter {
 public:
  FanParter(const Mesh& mesh, double distance)
      : mesh_(mesh), distance_(distance), fans_(mesh.topology.vertex_count, 0), visited_(mesh.topology.origin.size()) {
    made_ = mesh.triangles();
  }

  TriangleMesh run() {
    Fan fan;
    for (uint32_t h = 0; h < mesh_.topology.half_edge_count(); ++h) {
      if (visited_[h]) continue;
      collect_fan(mesh_.topology, h, fan);
      for (const uint32_t spoke : fan.spokes) visited_[spoke] = true;
      if (fans_[fan.centre]++ > 0) part(fan, fans_[fan.centre]);
    }
    for (uint32_t h = 0; h < mesh_.topology.half_edge_count(); ++h)
      if (is_back(mesh_.topology, h / 3)) part_corner(h);
    return std::move(made_);
  }
  [[nodiscard]] uint32_t parted() const {
    return static_cast<uint32_t>(std::ranges::count_if(fans_, [](uint32_t fans) { return fans > 1; }));
  }

 private:
  /// Gives a corner of a face that lies back to back with another its own vertex.
  void part_corner(uint32_t h) {
    const uint32_t v = mesh_.topology.origin[h];
    part({.centre = v, .spokes = {h}, .ring = {mesh_.topology.tip(h), mesh_.topology.apex(h)}}, ++fans_[v]);
  }

  /// Gives fan `number` of a vertex, from 2 on, its own vertex.
  void part(const Fan& fan, uint32_t number) {
    const Vec3d place = to_double(mesh_.positions[fan.centre]);
    Vec3d middle;
    for (const uint32_t v : fan.ring)
      middle += (1.0 / static_cast<double>(fan.ring.size())) * to_double(mesh_.positions[v]);
    const Vec3d way = middle - place;
    const double size = length(way);
    const double share = size > 0 ? std::min(most_of_way, distance_ / size) * (1 - 1.0 / number) : 0;
    std::map<uint32_t, uint32_t> made;  // new points of the fan, by old ones
    for (const uint32_t spoke : fan.spokes) {
      uint32_t& point = made_.triangles[spoke / 3][spoke % 3];
      const auto [known, is_new] = made.try_emplace(point);
      if (is_new) known->second = add_point(point, to_float(place + share * way));
      point = known->second;
    }
  }

  /// Adds a point at `place` with the values of another.
  uint32_t add_point(uint32_t other, Vec3f place) {
    const auto made = static_cast<uint32_t>(made_.positions.size());
    made_.positions.push_back(place);
    for (Attribute& attribute : made_.attributes)
      for (uint32_t i = 0; i < attribute.components; ++i)
        attribute.values.push_back(attribute.values[size_t{other} * attribute.components + i]);
    return made;
  }

  const Mesh& mesh_;
  double distance_;
  TriangleMesh made_;
  std::vector<uint32_t> fans_;  // [V] number of fans so far
  std::vector<bool> visited_;   // [H]
};

}  // namespace

ManifoldSurface manifold_surface(const TriangleMesh& triangles, double distance) {
  ManifoldSurface made{.mesh = build_mesh(triangles)};
  for (int round = 0; round < most_rounds_of_parting && needs_parting(made.mesh.topology); ++round) {
    FanParter parter(made.mesh, distance);
    const TriangleMesh parted = parter.run();
    made.parted = std::max(made.parted, parter.parted());
    made.mesh = build_mesh(parted);
  }
  require_manifold(made.mesh);
  return made;
}

void require_manifold(const Mesh& mesh) {
  if (const uint32_t shared = shared_edges(mesh.topology); shared > 0)
    throw Error(Fault::bad_surface, "The surface is not manifold: " + std::to_string(shared) +
                                        " edges have three faces or more, or two that are wound against each other.");
  if (!mesh.topology.pinched.empty())
    throw Error(Fault::bad_surface, "The surface touches itself at " + std::to_string(mesh.topology.pinched.size()) +
                                        " vertices. Part them.");
}

}  // namespace papilio
