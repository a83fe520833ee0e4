#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/lazy_values.h"
#include "criteria/camera.h"
#include "criteria/deviation.h"
#include "criteria/deviation_range.h"
#include "criteria/flatness.h"
#include "criteria/view_culling.h"
#include "mesh/part.h"
#include "mesh/region.h"
#include "papilio/options.h"
#include "rules/features.h"

// Which edges a level splits: the criteria of the options, put together. Both schemes ask the same questions.

namespace papilio {

/// What is known of a mesh that is tried: all of it may be left out.
struct TrialContext {
  const Features* features = nullptr;  ///< its; with `part`, the parents'
  const Topology* parents = nullptr;   ///< that it was split from (split_in_four.h)
  /// Those of the parents of whose children normals are asked; null: all.
  const Buffer<uint32_t>* normals_of = nullptr;
  const Buffer<uint32_t>* asked_of = nullptr;  ///< between whose children the edges to be tried lie; null: all
  const Part* part = nullptr;           ///< of the parents that it was split from (split_part_in_four); null: all
  const EdgeMarks* complete = nullptr;  ///< the edges for which w can be applied; null: all
  int threads = 1;                      ///< at most so many work on it
};

/// What is known of a level's edges before any is split. Of edges that could not be computed, and of those not asked
/// for, the arrays mean nothing.
struct Trial {
  Buffer<Vec3f> normals{};          ///< [F]
  Buffer<Vec3f> made{};             ///< [E] the positions that their new vertices would have
  bool is_of_some = false;          ///< whether only some were asked for
  LazyValues<double> deviations{};  ///< [E] the deviations (deviation.h); or unknown; empty: none is kept
  LazyValues<float> bounds{};       ///< [E] no less than these; infinity where nothing is known; empty as above
  LazyValues<float> least{};        ///< [E] no more than these; 0 where nothing is known; empty without rooms
  Buffer<float> rooms{};            ///< [F] (deviation_range.h); empty where no ranges are found

  NormalProducts products{};  ///< (flatness.h)
  bool is_kept = false;       ///< for later requests too: what one finds serves all

  static constexpr int unknown = -1;
  /// Makes room for what is found out about what was made; nothing is known yet.
  void forget();
  /// Makes room for what is found out, and for what only later requests gain by.
  void keep(const Topology& mesh);
  [[nodiscard]] Vec3f at(uint32_t edge) const { return made[edge]; }
  /// Squared distance of a tried edge's vertex from the edge's middle. `mesh` is the one tried.
  [[nodiscard]] double squared_offset(const Mesh& mesh, uint32_t edge) const {
    const uint32_t h = mesh.topology.half_edge[edge];
    return squared_distance_to_middle(at(edge), mesh.positions[mesh.topology.origin[h]],
                                      mesh.positions[mesh.topology.tip(h)]);
  }
  /// The deviation of a tried edge.
  [[nodiscard]] double deviation_at(const Mesh& mesh, uint32_t edge) const;
  /// Never less than that, and cheap: how far the vertex is from the midpoint, which is on the surface.
  [[nodiscard]] double most_deviation_at(const Mesh& mesh, uint32_t edge) const;
  /// Never less than that, of what is known already; infinity where nothing is.
  [[nodiscard]] float no_less_than_deviation_at(uint32_t edge) const {
    return bounds.empty() ? std::numeric_limits<float>::infinity() : bounds.get(edge);
  }
  /// Never more than that, of what is known already.
  [[nodiscard]] float no_more_than_deviation_at(uint32_t edge) const { return least.get(edge); }
  /// Makes room for what the options ask of deviations: none where they hold them against nothing. Where against a
  /// tolerance, has ranges found (deviation_range.h). Not for what is kept: where more views are to come the deviations
  /// themselves serve all of them.
  void prepare_errors(const Mesh& mesh, const Options& options, const TrialContext& context);
  [[nodiscard]] bool has_ranges() const { return !rooms.empty(); }
  /// Of these edges, which were tried.
  void find_ranges(const Mesh& mesh, std::span<const uint32_t> edges) const;
};

/// Writes to `made` [E] the positions of the new vertices of all edges for which that can be done, under the options'
/// tension and w; `normals` [F] where there is tension. The mesh's faces may be left out where the rules are plain, its
/// parents are given, and all features are rings.
void make_vertices(const Mesh& mesh, const Buffer<Vec3f>& normals, const Options& options, const TrialContext& context,
                   Vec3f* made);
/// Computes the new vertices, and the normals that this takes. No room is made for what is found out about them.
[[nodiscard]] Trial try_split(const Mesh& mesh, const Options& options, const TrialContext& context = {});

class Selection {
 public:
  /// `diagonal` of the coarse mesh's box. The options must outlive this.
  Selection(const Options& options, double diagonal);
  Selection(const Selection&) = delete;
  Selection& operator=(const Selection&) = delete;

  /// No criterion: every edge is split.
  [[nodiscard]] bool is_uniform() const;
  /// Errors decide, not only yes and no: there is a tolerance or a budget.
  [[nodiscard]] bool is_by_error() const;
  /// The view alone decides: its outline, which lies below faces that are turned away themselves, is refined too.
  [[nodiscard]] bool follows_outline() const { return camera_ && options_.flatness.empty() && !is_by_error(); }
  /// What an edge's error must reach for it to be split.
  [[nodiscard]] float threshold() const { return measure_.threshold(); }
  /// Of the coarse mesh's box.
  [[nodiscard]] double diagonal() const { return measure_.diagonal(); }
  [[nodiscard]] const Camera* camera() const { return camera_ ? &*camera_ : nullptr; }
  /// No less than the view has anywhere in the box; 0 without one.
  [[nodiscard]] double highest_pixels_per_unit(const Box& box) const {
    return camera_ ? camera_->highest_pixels_per_unit(box) : 0;
  }

  /// The edges that the view shows, however small they look; all of them without a view. `longest` [V] edges
  /// (view_culling.h), `box` of the vertices; `shared`: the half-edges at shared edges.
  [[nodiscard]] EdgesShown shown(const Mesh& mesh, const Trial& trial, const Buffer<double>& longest, const Box& box,
                                 const Buffer<uint32_t>& shared) const;
  /// The region's edges that flatness (with growth) and the view want split, the paper's method, in its order; of these
  /// those whose error (below) may be `least` or more. `level` is the one to be made, from 1. In ascending order.
  [[nodiscard]] Buffer<uint32_t> wanted(const Mesh& mesh, const Trial& trial, int level, const Region& region,
                                        const EdgesShown& shown, const Box& box, float least) const;

  /// Whether the view keeps the edge from being split: it does not show it, or it looks too short.
  [[nodiscard]] bool is_kept_by_view(const Mesh& mesh, const EdgesShown& shown, uint32_t edge) const;
  /// Whether the halves of the edge may look long enough for the view; an edge's halves are longer than half of it.
  [[nodiscard]] bool may_have_long_halves(const Mesh& mesh, uint32_t edge) const;

  /// What errors that reach a threshold are to be: where more is done with them than to compare them with it, exact.
  enum class Reaching { exact, no_more };
  /// The error of each wanted edge, which must have been tried; minus infinity elsewhere. Those below `threshold` may
  /// come out larger, those that reach it smaller if they may be `no_more`, but on their side of it: they cost less.
  /// `box` of the vertices. [E]
  [[nodiscard]] Buffer<float> errors(const Mesh& mesh, const Trial& trial, const Buffer<uint32_t>& wanted,
                                     const Box& box, float threshold, Reaching reaching = Reaching::exact) const;

  /// The error that the edge would have with this deviation; infinity where that is not known (lights).
  [[nodiscard]] float error_of(const Mesh& mesh, const Trial& trial, uint32_t edge, double distance) const;

  /// Whether a level after this one could have targets where this one has none: its flatness threshold is higher.
  [[nodiscard]] bool later_level_is_finer(int level) const;

 private:
  friend class ErrorLeft;
  /// The region's edges that flatness wants split, with growth; all of them without it.
  [[nodiscard]] Buffer<uint32_t> curved(const Mesh& mesh, const Trial& trial, int level, const Region& region) const;
  [[nodiscard]] double flatness_of(int level) const;

  const Options& options_;
  std::optional<Camera> camera_;
  ErrorMeasure measure_;
};

/// Collects the largest deviation left, for the result.
class ErrorLeft {
 public:
  explicit ErrorLeft(const Selection& selection) : measure_(&selection.measure_) {}
  /// A tried edge that stays, or, with share 1/4, one of the last level that was split. `scale`: the level's
  /// `highest_pixels_per_unit`.
  void add(const Mesh& mesh, const Trial& trial, double scale, uint32_t edge, double share = 1) {
    if (!may_grow_by(share * trial.most_deviation_at(mesh, edge), scale)) return;
    const double distance = share * trial.deviation_at(mesh, edge);
    if (!may_grow_by(distance, scale)) return;
    distance_ = std::max(distance_, distance);
    pixels_ = std::max(pixels_, measure_->pixels(mesh, edge, distance));
  }
  /// A deviation without a view.
  void add_distance(double distance) { distance_ = std::max(distance_, distance); }
  [[nodiscard]] double distance() const { return distance_; }
  /// Whether a deviation of at most that may be the largest.
  [[nodiscard]] bool may_grow_by(double most, double scale) const {
    return may_grow_by_distance(most) || may_grow_by_pixels(most * scale);
  }
  /// The same of a deviation at the edge, whose own scale is taken.
  [[nodiscard]] bool may_grow_at(const Mesh& mesh, uint32_t edge, double most) const {
    return may_grow_by_distance(most) || may_grow_by_pixels(measure_->pixels(mesh, edge, most));
  }
  /// A smaller deviation is not the largest. `scale` as above.
  [[nodiscard]] double least_that_matters(double scale) const {
    return scale > 0 ? std::min(distance_, pixels_ / scale) : distance_;
  }
  [[nodiscard]] bool may_grow_by_distance(double most) const { return most > distance_; }
  [[nodiscard]] bool may_grow_by_pixels(double most) const { return most > pixels_; }
  [[nodiscard]] double error() const { return measure_->diagonal() > 0 ? distance_ / measure_->diagonal() : 0; }
  [[nodiscard]] double pixels() const { return pixels_; }

 private:
  const ErrorMeasure* measure_;
  double distance_ = 0;
  double pixels_ = 0;
};

/// What is left of a deviation where a smooth surface is split once more.
inline constexpr double split_leaves = 0.25;

}  // namespace papilio
