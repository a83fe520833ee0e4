#include "detail/manifold_surface.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "mesh/fan.h"
#include "papilio/error.h"

namespace papilio {
namespace {

/// A vertex that is moved may land on another one, which takes another round.
constexpr int most_rounds = 4;
/// No vertex moves by a larger share of the way to its neighbours.
constexpr double most_of_way = 0.25;

uint32_t shared_edges(const Topology& t) { return static_cast<uint32_t>(std::ranges::count(t.kind, EdgeKind::shared)); }

bool is_manifold(const Topology& t) { return shared_edges(t) == 0 && t.pinched.empty(); }

/// Parts the fans of a mesh.
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
    return std::move(made_);
  }
  [[nodiscard]] uint32_t parted() const {
    return static_cast<uint32_t>(std::ranges::count_if(fans_, [](uint32_t fans) { return fans > 1; }));
  }

 private:
  /// Gives the vertex's fan of this number, from 2 on, a vertex of its own.
  void part(const Fan& fan, uint32_t number) {
    const Vec3d place = to_double(mesh_.positions[fan.centre]);
    Vec3d middle;
    for (const uint32_t v : fan.ring)
      middle += (1.0 / static_cast<double>(fan.ring.size())) * to_double(mesh_.positions[v]);
    const Vec3d way = middle - place;
    const double size = length(way);
    const double share = size > 0 ? std::min(most_of_way, distance_ / size) * (1 - 1.0 / number) : 0;
    std::vector<std::pair<uint32_t, uint32_t>> made;  // points of the fan, before and after
    for (const uint32_t spoke : fan.spokes) {
      uint32_t& point = made_.triangles[spoke / 3][spoke % 3];
      auto known = std::ranges::find(made, point, &std::pair<uint32_t, uint32_t>::first);
      if (known == made.end()) known = made.emplace(known, point, add_point(point, to_float(place + share * way)));
      point = known->second;
    }
  }

  /// Adds a point at this place with the values of another one.
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
  std::vector<uint32_t> fans_;  // [V] seen
  std::vector<bool> visited_;   // [H]
};

}  // namespace

ManifoldSurface manifold_surface(const TriangleMesh& triangles, double distance) {
  ManifoldSurface made{.mesh = build_mesh(triangles)};
  for (int round = 0; round < most_rounds && !is_manifold(made.mesh.topology); ++round) {
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
