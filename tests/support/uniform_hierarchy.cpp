#include "tests/support/uniform_hierarchy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace papilio::test {
namespace {

Triangle sorted(Triangle t) {
  std::ranges::sort(t);
  return t;
}

uint64_t hash(Vec3f p) {
  const auto bits = [](float c) { return uint64_t{std::bit_cast<uint32_t>(c)}; };
  return (bits(p.x) * 0x9e3779b97f4a7c15ULL + bits(p.y)) * 0xbf58476d1ce4e5b9ULL + bits(p.z);
}

}  // namespace

UniformHierarchy::UniformHierarchy(const Mesh& coarse, const Options& options) {
  Options uniform;
  uniform.levels = options.levels;
  uniform.tension = options.tension;
  uniform.shape = options.shape;
  uniform.w = options.w;
  uniform.crease_angle = options.crease_angle;
  const auto add = [&](const Level& level) { add_level(level.mesh.topology, level.level, !level.last); };
  finest_ = refine(coarse, uniform, {.on_level = add}).mesh;
  std::ranges::sort(pieces_);
  for (uint32_t v = 0; v < finest_.positions.size(); ++v) at_position_.emplace(hash(finest_.positions[v]), v);
}

void UniformHierarchy::add_level(const Topology& mesh, int level, bool may_be_cut) {
  // Vertices of the next level are in the order of this level's edges.
  const auto middle = [&](uint32_t h) { return mesh.vertex_count + mesh.edge[h]; };
  for (uint32_t f = 0; f < mesh.face_count(); ++f) {
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) { pieces_.push_back({sorted({a, b, c}), level}); };
    add(mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2]);
    if (!may_be_cut) continue;
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
      const uint32_t a = mesh.origin[h];
      const uint32_t b = mesh.tip(h);
      const uint32_t c = mesh.apex(h);
      const uint32_t ab = middle(h);
      const uint32_t bc = middle(Topology::next(h));
      add(a, ab, c);  // one split edge
      add(ab, b, c);
      add(ab, b, bc);  // two: the corner, and either diagonal
      add(a, ab, bc);
      add(a, bc, c);
      add(ab, bc, c);
    }
  }
}

::testing::AssertionResult UniformHierarchy::contains(const Mesh& mesh) const {
  std::vector<uint32_t> same(mesh.positions.size());
  for (uint32_t v = 0; v < same.size(); ++v) {
    const auto found = at_position_.find(hash(mesh.positions[v]));
    if (found == at_position_.end() || finest_.positions[found->second] != mesh.positions[v])
      return ::testing::AssertionFailure() << "vertex " << v << " is none of the uniform result's";
    same[v] = found->second;
  }
  std::vector<int> level(mesh.topology.face_count());
  for (uint32_t f = 0; f < level.size(); ++f) {
    Triangle t{};
    for (uint32_t i = 0; i < 3; ++i) t[i] = same[mesh.topology.origin[3 * f + i]];
    const auto found = std::ranges::lower_bound(pieces_, sorted(t), {}, &Piece::corners);
    if (found == pieces_.end() || found->corners != sorted(t))
      return ::testing::AssertionFailure() << "face " << f << " is no piece of a uniform face";
    level[f] = found->level;
  }
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t t = mesh.topology.twin[h];
    if (t != none && std::abs(level[Topology::face(h)] - level[Topology::face(t)]) > 1)
      return ::testing::AssertionFailure() << "faces at half-edge " << h << " are more than one level apart";
  }
  return ::testing::AssertionSuccess();
}

double smallest_angle(const Mesh& mesh) {
  double least = std::numbers::pi;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const Vec3d a = to_double(mesh.positions[mesh.topology.origin[h]]);
    const Vec3d u = to_double(mesh.positions[mesh.topology.tip(h)]) - a;
    const Vec3d v = to_double(mesh.positions[mesh.topology.apex(h)]) - a;
    least = std::min(least, std::atan2(length(cross(u, v)), dot(u, v)));
  }
  return least;
}

}  // namespace papilio::test
