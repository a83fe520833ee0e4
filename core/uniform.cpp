#include "uniform.h"

#include <algorithm>
#include <cmath>

#include "attributes.h"
#include "butterfly.h"
#include "features.h"
#include "lanes.h"
#include "normals.h"
#include "parallel.h"
#include "split.h"
#include "split_in_four.h"

namespace papilio {
namespace {

constexpr uint64_t bytes_per_face = 110;  // of a level's arrays, while those of the level before are still there

float largest_coordinate(const Array<Vec3f>& positions) {
  Lanes largest{};
  for (const Vec3f& p : positions) largest = larger(largest, larger(widen(p), -1.0F * widen(p)));
  return std::max({largest.v[0], largest.v[1], largest.v[2]});
}

class Uniform {
 public:
  Uniform(const Options& options, const Selection& selection, const Progress& progress)
      : options_(options), selection_(selection), progress_(progress) {}

  Result run(Mesh coarse) {
    mesh_ = std::move(coarse);
    features_ = find_features(mesh_.topology);
    rounding_ = 2e-6 * largest_coordinate(mesh_.positions);
    for (int level = 1; level <= options_.levels; ++level) {
      progress_.poll();
      const uint64_t faces = 4ULL * mesh_.topology.face_count();
      progress_.require_room(faces, level);
      progress_.require_memory(faces, bytes_per_face + bytes_per_face_of(mesh_.attributes), level);
      progress_.report(level - 1, mesh_);
      make_vertices();
      progress_.poll();
      const bool is_last = level == options_.levels;
      if (is_last) result_.error = error_left();
      split(is_last);
      result_.levels = level;
    }
    result_.mesh = std::move(mesh_);
    return std::move(result_);
  }

 private:
  /// Appends the new vertices to the positions.
  void make_vertices() {
    const Topology& topology = mesh_.topology;
    if (options_.w == 0 && options_.tension == Tension::off) {
      append_vertices(nullptr);
      return;
    }
    const Array<Vec3f> normals =
        options_.tension == Tension::off ? Array<Vec3f>{} : face_normals(mesh_, progress_.threads());
    if (options_.w == 0) {
      const TensionField field = tension_field(topology, normals, options_.tension);
      append_vertices(&field);
    } else {
      const Array<Vec3f> made = papilio::make_vertices(mesh_, normals, options_, everything());
      mesh_.positions.insert(mesh_.positions.end(), made.begin(), made.end());
    }
  }

  void append_vertices(const TensionField* tension) {
    const Topology& topology = mesh_.topology;
    mesh_.positions.resize(size_t{topology.vertex_count} + topology.edge_count());
    Vec3f* positions = mesh_.positions.data();
    uniform_butterfly(topology, features_, positions, positions + topology.vertex_count, tension, progress_.threads());
  }

  /// That of the edges of the last level, which are not tried: a share of what their parents had. Most edges are seen
  /// to matter less than another by how far their vertex is from the midpoint, which is on the surface.
  [[nodiscard]] double error_left() const {
    const uint32_t edges = mesh_.topology.edge_count();
    const uint32_t parts = parts_of(edges, progress_.threads());
    std::vector<ErrorLeft> left(parts, ErrorLeft(selection_));
    for_each_part(parts, edges, [&](uint32_t part, uint32_t first, uint32_t last) {
      ErrorLeft own(selection_);
      add_error_left(first, last, own);
      left[part] = own;
    });
    return std::ranges::max_element(left, {}, &ErrorLeft::distance)->error();
  }

  void add_error_left(uint32_t first, uint32_t last, ErrorLeft& left) const {
    const Topology& topology = mesh_.topology;
    float most_skipped = -1;  // its square
    for (uint32_t e = first; e < last; ++e) {
      const uint32_t h = topology.half_edge[e];
      const Vec3f& made = mesh_.positions[topology.vertex_count + e];
      const Lanes ends = widen(mesh_.positions[topology.origin[h]]) + widen(mesh_.positions[topology.tip(h)]);
      if (squared_length(widen(made) - 0.5F * ends) <= most_skipped) continue;
      left.add_distance(split_leaves * deviation(mesh_, e, made));
      const double sure = left.distance() / split_leaves - rounding_;
      if (sure > least_squared) most_skipped = static_cast<float>(sure * sure);
    }
  }

  void split(bool is_last) {
    if (!is_last) descend(features_, mesh_.topology);
    if (!mesh_.attributes.empty())
      mesh_.topology = papilio::split(mesh_.topology, everything(), mesh_.positions, mesh_.attributes);
    else if (is_last && !options_.edges)
      mesh_.topology = split_last_in_four(mesh_.topology, progress_.threads());
    else
      mesh_.topology = split_in_four(mesh_.topology, progress_.threads());
  }

  [[nodiscard]] SplitPlan everything() const { return SplitPlan(EdgeMarks(mesh_.topology.edge_count(), 1)); }

  static constexpr double least_squared = 1e-15;  ///< squares of smaller floats lose digits

  const Options& options_;
  const Selection& selection_;
  const Progress& progress_;
  Mesh mesh_;
  Features features_;
  double rounding_ = 0;  ///< more than floats make of the distance between two points of the mesh
  Result result_;
};

}  // namespace

Result refine_uniformly(Mesh coarse, const Options& options, const Selection& selection, const Progress& progress) {
  return Uniform(options, selection, progress).run(std::move(coarse));
}

}  // namespace papilio
