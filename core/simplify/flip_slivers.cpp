#include "simplify/flip_slivers.h"

#include <algorithm>
#include <utility>

#include "mesh/attributes.h"
#include "mesh/connect.h"
#include "mesh/fan.h"

namespace papilio {
namespace {

/// Upper bound of a sliver's height, a share of its longest edge.
constexpr double sliver_height = 1e-6;
/// Upper bound of the rounds: slivers beside slivers take several.
constexpr int max_rounds = 16;
/// Upper bound of the faces at a sliver's apex, all of which are visited for each sliver.
constexpr uint32_t most_faces = 1000;

/// Returns the longest half-edge of the face if it is a sliver, else `none`.
uint32_t longest_of_sliver(const Mesh& mesh, uint32_t face) {
  uint32_t longest = none;
  double longest_squared = -1;
  for (uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
    const Vec3d along =
        to_double(mesh.positions[mesh.topology.tip(h)]) - to_double(mesh.positions[mesh.topology.origin[h]]);
    if (dot(along, along) > longest_squared) longest = h;
    longest_squared = std::max(longest_squared, dot(along, along));
  }
  const Vec3d a = to_double(mesh.positions[mesh.topology.origin[longest]]);
  const Vec3d twice_area = cross(to_double(mesh.positions[mesh.topology.tip(longest)]) - a,
                                 to_double(mesh.positions[mesh.topology.apex(longest)]) - a);
  return length(twice_area) <= sliver_height * longest_squared ? longest : none;
}

class Flipper {
 public:
  Flipper(Mesh& mesh, uint32_t first)
      : mesh_(mesh), first_(first), touched_(mesh.topology.face_count()), faces_(mesh.topology.vertex_count, 0) {
    for (uint32_t v : mesh.topology.origin) ++faces_[v];
  }

  /// Flips the longest edges of slivers, no face twice. Returns whether any edge was flipped.
  bool run() {
    bool any = false;
    for (uint32_t f = first_; f < mesh_.topology.face_count(); ++f) {
      const uint32_t h = longest_of_sliver(mesh_, f);
      if (h == none || !may_flip(h)) continue;
      flip(h);
      any = true;
    }
    if (any) mesh_.topology = connect_faces(std::move(origin_), mesh_.topology.vertex_count);
    return any;
  }

 private:
  bool may_flip(uint32_t h) {
    const Topology& topology = mesh_.topology;
    if (topology.is_curve(h) || faces_[topology.apex(h)] > most_faces) return false;
    const uint32_t t = topology.twin[h];
    const uint32_t beyond = Topology::face(t);
    if (beyond < first_ || touched_[Topology::face(h)] || touched_[beyond]) return false;
    if (longest_of_sliver(mesh_, beyond) != none) return false;
    if (is_seam(topology, mesh_.attributes, h)) return false;
    collect_fan(topology, Topology::previous(h), fan_);
    return topology.apex(h) != topology.apex(t) && std::ranges::find(fan_.ring, topology.apex(t)) == fan_.ring.end();
  }

  /// Replaces the edge by one between the apexes of its faces.
  void flip(uint32_t h) {
    const uint32_t t = mesh_.topology.twin[h];
    const auto turn = [&](Buffer<uint32_t>& corners) {
      corners[Topology::next(h)] = corners[Topology::previous(t)];
      corners[Topology::next(t)] = corners[Topology::previous(h)];
    };
    if (origin_.empty()) origin_ = mesh_.topology.origin;
    turn(origin_);
    if (!mesh_.attributes.empty()) turn(mesh_.attributes.point);
    touched_[Topology::face(h)] = touched_[Topology::face(t)] = true;
  }

  Mesh& mesh_;
  uint32_t first_;
  std::vector<bool> touched_;
  std::vector<uint32_t> faces_;  ///< [V] number of faces
  Buffer<uint32_t> origin_;      ///< [H] origins after the flips; empty before the first one
  Fan fan_;
};

}  // namespace

void flip_slivers(Mesh& mesh, uint32_t first) {
  for (int round = 0; round < max_rounds; ++round)
    if (!Flipper(mesh, first).run()) return;
}

}  // namespace papilio
