#include "simplify/simplify.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/sort.h"
#include "criteria/camera.h"
#include "mesh/attributes.h"
#include "mesh/connect.h"
#include "mesh/normals.h"
#include "simplify/collapse.h"
#include "simplify/simplify_check.h"

namespace papilio {
namespace {

/// Upper bounds of the attempts with one error, and of the errors, each a quarter of the one before. At the default
/// error, no more than four attempts were observed.
constexpr int max_attempts = 10;
constexpr int max_errors = 3;
/// Rings of vertices round a fault that are locked for the next attempt. (2 leave up to half as many faces again.)
constexpr uint32_t first_lock_rings = 1;
constexpr uint32_t last_lock_rings = 64;

/// Returns [V] the vertices to keep, including those at which meshoptimizer would see a border.
std::vector<bool> find_locked(const Mesh& mesh, const std::vector<bool>& hidden) {
  const Topology& topology = mesh.topology;
  std::vector<bool> locked(topology.vertex_count);
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h)
    if (!hidden[Topology::face(h)] || topology.is_curve(h) || is_seam(topology, mesh.attributes, h))
      locked[topology.origin[h]] = locked[topology.tip(h)] = true;
  for (uint32_t v : topology.pinched) locked[v] = true;
  return locked;
}

/// Faults of the attempts so far, and how far round each vertices were locked.
class Trouble {
 public:
  Trouble(const Topology& mesh, const std::function<void()>& poll)
      : mesh_(mesh), poll_(poll), reach_(mesh.vertex_count, 0) {}

  /// Locks the faults and their neighbourhoods. The radius doubles each time that a vertex is a fault again.
  void lock(std::vector<uint32_t> faults, std::vector<bool>& locked) {
    sort_range(faults);
    faults.erase(std::unique(faults.begin(), faults.end()), faults.end());
    std::vector<uint32_t> rings(mesh_.vertex_count, 0);  // 1 + remaining rings to lock from here
    uint32_t most = 0;
    for (uint32_t v : faults) {
      reach_[v] = reach_[v] == 0 ? first_lock_rings : std::min<uint32_t>(2 * reach_[v], last_lock_rings);
      rings[v] = reach_[v] + 1;
      most = std::max(most, reach_[v]);
    }
    for (uint32_t ring = 0; ring < most; ++ring) {
      poll_();
      for (uint32_t h = 0; h < mesh_.half_edge_count(); ++h) {
        uint32_t& a = rings[mesh_.origin[h]];
        uint32_t& b = rings[mesh_.tip(h)];
        if (a > b + 1) b = a - 1;
        if (b > a + 1) a = b - 1;
      }
    }
    for (uint32_t v = 0; v < mesh_.vertex_count; ++v)
      if (rings[v] > 0) locked[v] = true;
  }

 private:
  const Topology& mesh_;
  const std::function<void()>& poll_;
  std::vector<uint32_t> reach_;  ///< [V] rings locked round the vertex last time
};

/// Repeats the collapse until it makes no fault, with vertices round each fault locked. Returns nothing if all fail.
std::optional<Collapsed> simplify(const Mesh& mesh, const std::vector<bool>& hidden, const std::vector<bool>& to_lock,
                                  double error, const std::function<void()>& poll) {
  const Collapser collapser(mesh, hidden, poll);
  for (int k = 0; k < max_errors; ++k, error /= 4) {
    std::vector<bool> locked = to_lock;
    Trouble trouble(mesh.topology, poll);
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
      Collapsed result = collapser.run(locked, error);
      poll();
      std::vector<uint32_t> faults = find_faults(mesh, result, poll);
      poll();
      if (faults.empty()) {
        // Without a fault, a handle may have collapsed: a smaller error keeps it.
        if (result.mesh.topology.euler_characteristic() != mesh.topology.euler_characteristic()) break;
        return result;
      }
      trouble.lock(std::move(faults), locked);
    }
  }
  return std::nullopt;
}

/// Makes creases smooth, and returns their numbers.
std::vector<uint32_t> unmark_creases(Topology& mesh) {
  std::vector<uint32_t> creases;
  for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
    if (mesh.kind[e] != EdgeKind::crease) continue;
    mesh.kind[e] = EdgeKind::smooth;
    creases.push_back(e);
  }
  return creases;
}

/// Restores the creases and darts of the mesh before. Returns false if a crease is missing.
bool restore_creases(const Topology& before, const std::vector<uint32_t>& creases, Collapsed& after) {
  Topology& mesh = after.mesh.topology;
  using Ends = std::array<uint32_t, 2>;
  const auto ends = [](const Topology& in, uint32_t e) {
    const uint32_t h = in.half_edge[e];
    return Ends{std::min(in.origin[h], in.tip(h)), std::max(in.origin[h], in.tip(h))};
  };
  std::vector<Ends> expected;
  expected.reserve(creases.size());
  for (uint32_t e : creases) expected.push_back(ends(before, e));
  sort_range(expected);
  size_t found = 0;
  for (uint32_t e = 0; e < mesh.edge_count() && !expected.empty(); ++e) {
    const auto [a, b] = ends(mesh, e);
    if (!std::ranges::binary_search(expected, Ends{after.vertex[a], after.vertex[b]})) continue;
    mesh.kind[e] = EdgeKind::crease;
    ++found;
  }
  for (uint32_t v = 0; v < mesh.vertex_count; ++v)
    if (std::ranges::binary_search(before.darts, after.vertex[v])) mesh.darts.push_back(v);
  return found == expected.size();
}

}  // namespace

Mesh simplify_hidden(Mesh mesh, const Camera& camera, double error, const std::function<void()>& poll) {
  const std::vector<bool> hidden = hidden_faces(mesh, face_normals(mesh), camera);
  if (std::ranges::find(hidden, true) == hidden.end() || bounding_box(mesh.positions).diagonal() == 0) return mesh;
  const std::vector<bool> to_lock = find_locked(mesh, hidden);

  // As after connect_faces(), so that the mesh before compares with the result.
  const std::vector<uint32_t> creases = unmark_creases(mesh.topology);
  const std::vector<uint32_t> pinched = std::exchange(mesh.topology.pinched, find_pinched(mesh.topology));
  std::optional<Collapsed> result = simplify(mesh, hidden, to_lock, error, poll ? poll : std::function<void()>([] {}));
  if (result && restore_creases(mesh.topology, creases, *result)) return std::move(result->mesh);

  for (uint32_t e : creases) mesh.topology.kind[e] = EdgeKind::crease;
  mesh.topology.pinched = pinched;
  return mesh;
}

}  // namespace papilio
