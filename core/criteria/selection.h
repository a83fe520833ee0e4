#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/lazy_values.h"
#include "criteria/camera.h"
#include "criteria/deviation.h"
#include "criteria/flatness.h"
#include "criteria/view_culling.h"
#include "mesh/part.h"
#include "mesh/region.h"
#include "papilio/options.h"
#include "rules/features.h"

// Selection of the edges that a level splits, by all criteria of the options. Both schemes share it.

namespace papilio {

/// Optional context for the computation of a mesh's new vertices.
struct TrialContext {
  const Features* features = nullptr;  ///< features of the mesh; with `parents`, of the parents
  /// Mesh whose split gave this one, if the rules are plain and all features rings: then the mesh's own
  /// faces are not needed.
  const Topology* parents = nullptr;
  const Part* part = nullptr;       ///< part of the parents that was split (split_part_in_four); null: all
  const Marks* complete = nullptr;  ///< [E] edges to which w can be applied; null: all
  int threads = 1;                  ///< upper bound of the number of threads
};

/// Returns whether errors decide: there is a tolerance (of distance or pixels) or a budget.
[[nodiscard]] bool is_by_error(const Options& options);

/// Values of a level's edges before any is split. Values of edges that could not be computed, or were not requested,
/// are undefined.
struct Trial {
  Buffer<Vec3f> normals{};          ///< [F]
  Buffer<Vec3f> made{};             ///< [E] positions of the new vertices
  LazyValues<double> deviations{};  ///< [E] deviations (deviation.h) or `unknown`; empty: not stored
  LazyValues<float> bounds{};       ///< [E] upper bounds of deviations; infinity if unknown; empty: not stored

  bool is_kept = false;  ///< whether values are stored for later requests

  static constexpr int unknown = -1;
  /// Makes room for deviations and bounds, all unknown.
  void forget();
  /// Makes room for deviations and bounds, and stores them for later requests.
  void keep();
  [[nodiscard]] Vec3f at(EdgeId edge) const { return made[edge]; }
  /// Returns the squared distance of a tried edge's vertex from the edge's midpoint. `mesh` is the mesh tried.
  [[nodiscard]] double squared_offset(const Mesh& mesh, EdgeId edge) const {
    const HalfEdgeId h = mesh.topology.half_edge[edge];
    return squared_distance_to_middle(at(edge), mesh.positions[mesh.topology.origin[h]],
                                      mesh.positions[mesh.topology.tip(h)]);
  }
  /// Returns the deviation of a tried edge.
  [[nodiscard]] double deviation_at(const Mesh& mesh, EdgeId edge) const;
  /// Returns a cheap upper bound of the deviation: the stored one, or the distance from the vertex to the midpoint,
  /// which is on the surface.
  [[nodiscard]] double deviation_bound(const Mesh& mesh, EdgeId edge) const;
  /// Returns the stored upper bound of the deviation; infinity if there is none.
  [[nodiscard]] float stored_deviation_bound(EdgeId edge) const {
    return bounds.empty() ? std::numeric_limits<float>::infinity() : bounds.get(edge);
  }
};

/// Writes to `made` [E] the new vertices of all edges for which they can be computed, under the options' tension and w;
/// `normals` [F] if there is tension.
void make_vertices(const Mesh& mesh, const Buffer<Vec3f>& normals, const Options& options, const TrialContext& context,
                   Vec3f* made);
/// Computes the new vertices, and the normals required for them. Makes no room for deviations.
[[nodiscard]] Trial try_split(const Mesh& mesh, const Options& options, const TrialContext& context = {});

class Selection {
 public:
  /// `diagonal` is that of the coarse mesh's box. The options must outlive this object.
  Selection(const Options& options, double diagonal);
  Selection(const Selection&) = delete;
  Selection& operator=(const Selection&) = delete;

  /// Returns whether there is no criterion, so that every edge is split.
  [[nodiscard]] bool is_uniform() const;
  /// Returns whether errors decide under its options.
  [[nodiscard]] bool is_by_error() const;
  /// Returns whether a view decides, but not errors. Then its outline, below faces that are turned
  /// away, is refined too.
  [[nodiscard]] bool follows_outline() const { return camera_ && !is_by_error(); }
  /// Returns the least error at which an edge is split.
  [[nodiscard]] float threshold() const { return measure_.threshold(); }
  /// Returns the diagonal of the coarse mesh's box.
  [[nodiscard]] double diagonal() const { return measure_.diagonal(); }
  [[nodiscard]] const Camera* camera() const { return camera_ ? &*camera_ : nullptr; }
  /// Returns an upper bound of the view's pixels per unit in the box; 0 without a view.
  [[nodiscard]] double highest_pixels_per_unit(const Box& box) const {
    return camera_ ? camera_->highest_pixels_per_unit(box) : 0;
  }

  /// Returns the edges that the view shows, whatever their size; all edges without a view. `longest` [V] edges
  /// (view_culling.h); `shared`: half-edges at shared edges.
  [[nodiscard]] EdgesShown shown(const Mesh& mesh, const Trial& trial, const Buffer<double>& longest,
                                 const Buffer<uint32_t>& shared) const;
  /// Returns the region's edges selected by flatness (with growth) and view, in the order of the paper's method.
  /// Edges whose error (errors()) is surely below `least` are left out. `level` is the level to be made, from 1; `box`
  /// of the vertices. In ascending order.
  [[nodiscard]] Buffer<uint32_t> candidates(const Mesh& mesh, const Trial& trial, int level, const Region& region,
                                            const EdgesShown& shown, const Box& box, float least) const;

  /// Marks the region's edges selected by flatness, with growth, whatever the view shows; all of them without flatness.
  /// `level` is the level to be made, from 1. [E]
  [[nodiscard]] Marks curved(const Mesh& mesh, const Trial& trial, int level, const Region& region) const;

  /// Returns whether the view prevents the split of the edge: the edge is not shown, or too short in pixels.
  [[nodiscard]] bool is_kept_by_view(const Mesh& mesh, const EdgesShown& shown, EdgeId edge) const;
  /// Returns whether the halves of the edge may be long enough in pixels. Halves are longer than half of the edge.
  [[nodiscard]] bool may_have_long_halves(const Mesh& mesh, EdgeId edge) const;

  /// Returns the error of each edge in `candidates`, which must have been tried; minus infinity elsewhere. [E]
  /// An error below `threshold` may be replaced by an upper bound that is also below it, which costs less.
  [[nodiscard]] Buffer<float> errors(const Mesh& mesh, const Trial& trial, const Buffer<uint32_t>& candidates,
                                     float threshold) const;
  /// Returns the error of the edge for this deviation; infinity where that is unknown (lights).
  [[nodiscard]] float error_of(const Mesh& mesh, const Trial& trial, EdgeId edge, double distance) const;

  /// Returns whether a later level could have targets if this one has none: its flatness threshold is higher.
  [[nodiscard]] bool later_level_is_finer(int level) const;

 private:
  friend class ErrorLeft;
  [[nodiscard]] double flatness_of(int level) const;

  const Options& options_;
  std::optional<Camera> camera_;
  ErrorMeasure measure_;
};

/// Largest deviation left, for the result.
class ErrorLeft {
 public:
  explicit ErrorLeft(const Selection& selection) : measure_(&selection.measure_) {}
  /// Adds a tried edge that stays, or, with share 1/4, one of the last level that was split. `scale` is the level's
  /// `highest_pixels_per_unit`.
  void add(const Mesh& mesh, const Trial& trial, double scale, EdgeId edge, double share = 1) {
    const double most = share * trial.deviation_bound(mesh, edge);
    if (!may_grow_by(most, scale) || !may_grow_at(mesh, edge, most)) return;
    const double distance = share * trial.deviation_at(mesh, edge);
    distance_ = std::max(distance_, distance);
    pixels_ = std::max(pixels_, measure_->pixels(mesh, edge, distance));
  }
  /// Adds a deviation without a view.
  void add_distance(double distance) { distance_ = std::max(distance_, distance); }
  /// Returns whether a deviation of at most `most` may be the largest.
  [[nodiscard]] bool may_grow_by(double most, double scale) const { return most > distance_ || most * scale > pixels_; }
  /// Returns whether a deviation of at most `most` at the edge may be the largest, by the scale at the edge.
  [[nodiscard]] bool may_grow_at(const Mesh& mesh, EdgeId edge, double most) const {
    return most > distance_ || measure_->pixels(mesh, edge, most) > pixels_;
  }
  /// Returns a lower bound of the largest deviation: smaller ones do not count. `scale`: see add().
  [[nodiscard]] double least_that_matters(double scale) const {
    return scale > 0 ? std::min(distance_, pixels_ / scale) : distance_;
  }
  [[nodiscard]] double error() const { return measure_->diagonal() > 0 ? distance_ / measure_->diagonal() : 0; }
  [[nodiscard]] double pixels() const { return pixels_; }

 private:
  const ErrorMeasure* measure_;
  double distance_ = 0;
  double pixels_ = 0;
};

/// Share of a deviation that is left after one more split, where the surface is smooth.
inline constexpr double split_leaves = 0.25;

}  // namespace papilio
