#include "criteria/selection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "criteria/camera.h"
#include "criteria/flatness.h"
#include "criteria/view_culling.h"
#include "mesh/normals.h"
#include "rules/butterfly.h"
#include "rules/family_butterfly.h"
#include "rules/tension.h"

namespace papilio {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float never = -infinity;

/// Returns a float >= the number, which must not be negative.
float rounded_up(double number) { return static_cast<float>(1.000001 * number + std::numeric_limits<float>::min()); }

}  // namespace

void make_vertices(const Mesh& mesh, const Buffer<Vec3f>& normals, const Options& options, const TrialContext& context,
                   Vec3f* made) {
  const Vec3f* positions = mesh.positions.data();
  std::optional<Features> found;
  if (context.features == nullptr) found = find_features(mesh.topology);
  const Features& features = found ? *found : *context.features;
  if (context.parents != nullptr)
    return butterfly_below(*context.parents, context.part, features, positions, made, context.threads);
  std::optional<TensionField> field;
  if (options.tension != Tension::off) field = tension_field(mesh, normals, options.tension);
  butterfly<float>(mesh.topology, features, positions, made,
                   {.w = static_cast<float>(options.w),
                    .tension = field ? &*field : nullptr,
                    .complete = context.complete,
                    .threads = context.threads});
}

bool is_by_error(const Options& options) {
  return options.tolerance > 0 || options.max_faces > 0 || (options.view && options.view->error_pixels > 0);
}

Trial try_split(const Mesh& mesh, const Options& options, const TrialContext& context) {
  Trial trial{.normals = face_normals(mesh, context.threads)};
  trial.made.resize_for_overwrite(mesh.topology.edge_count());
  make_vertices(mesh, trial.normals, options, context, trial.made.data());
  return trial;
}

void Trial::forget() {
  deviations = LazyValues<double>(made.size(), unknown);
  bounds = LazyValues<float>(made.size(), infinity);
}

void Trial::keep() {
  forget();
  is_kept = true;
}

double Trial::deviation_bound(const Mesh& mesh, EdgeId edge) const {
  float known = stored_deviation_bound(edge);
  if (known != infinity) return known;
  known = rounded_up(std::sqrt(squared_offset(mesh, edge)));
  if (!bounds.empty()) bounds.put(edge, known);
  return known;
}

double Trial::deviation_at(const Mesh& mesh, EdgeId edge) const {
  if (deviations.empty()) return deviation(mesh, edge, at(edge));
  double known = deviations.get(edge);
  if (known == unknown) {
    deviations.put(edge, known = deviation(mesh, edge, made[edge]));
    bounds.put(edge, rounded_up(known));
  }
  return known;
}

Selection::Selection(const Options& options, double diagonal)
    : options_(options),
      camera_(options.view ? std::optional<Camera>(*options.view) : std::nullopt),
      measure_(options.tolerance, diagonal, options.view ? &*options.view : nullptr, camera()) {}

bool Selection::is_uniform() const { return options_.flatness.empty() && !options_.view && !is_by_error(); }

bool Selection::is_by_error() const { return papilio::is_by_error(options_); }

double Selection::flatness_of(int level) const {
  const auto index = static_cast<size_t>(level - 1);
  return index < options_.flatness.size() ? options_.flatness[index] : options_.flatness.back();
}

float Selection::error_of(const Mesh& mesh, const Trial& trial, EdgeId edge, double distance) const {
  return measure_.grows_with_distance() ? measure_.error(mesh, trial.normals, edge, distance) : infinity;
}

bool Selection::later_level_is_finer(int level) const {
  if (options_.flatness.empty()) return false;
  for (int later = level + 1; later <= options_.levels; ++later)
    if (flatness_of(later) > flatness_of(level)) return true;
  return false;
}

EdgesShown Selection::shown(const Mesh& mesh, const Trial& trial, const Buffer<double>& longest,
                            const Buffer<uint32_t>& shared) const {
  if (!camera_) return {};
  return {mesh, trial.normals, longest, *camera_, shared};
}

Marks Selection::curved(const Mesh& mesh, const Trial& trial, int level, const Region& region) const {
  if (options_.flatness.empty()) return region.has_edge;
  return find_curved(mesh, trial.normals, flatness_of(level), options_.growth, region);
}

Buffer<uint32_t> Selection::candidates(const Mesh& mesh, const Trial& trial, int level, const Region& region,
                                       const EdgesShown& shown, const Box& box, float least) const {
  Buffer<uint32_t> edges = options_.flatness.empty() ? region.edges() : marked(curved(mesh, trial, level, region));
  const double needed = is_by_error() ? measure_.least_deviation(least, highest_pixels_per_unit(box)) : 0;
  if (needed > 0) {
    keep_if(edges, [&](EdgeId e) { return trial.deviation_bound(mesh, e) >= needed; });
    // A kept level stores its deviations for all views, whether this view shows the edge or not.
    if (trial.is_kept) keep_if(edges, [&](EdgeId e) { return trial.deviation_at(mesh, e) >= needed; });
  }
  if (camera_) keep_if(edges, [&](EdgeId e) { return !is_kept_by_view(mesh, shown, e); });
  return edges;
}

bool Selection::is_kept_by_view(const Mesh& mesh, const EdgesShown& shown, EdgeId edge) const {
  return camera_ && (!shown[edge] || !is_long(mesh, *camera_, options_.view->edge_pixels, edge));
}

bool Selection::may_have_long_halves(const Mesh& mesh, EdgeId edge) const {
  constexpr double least = 1.5;  // as a multiple of the length required of a half
  return !camera_ || is_long(mesh, *camera_, least * options_.view->edge_pixels, edge);
}

Buffer<float> Selection::errors(const Mesh& mesh, const Trial& trial, const Buffer<uint32_t>& candidates,
                                float threshold) const {
  Buffer<float> errors(mesh.topology.edge_count(), never);
  const auto error = [&](EdgeId e, double distance) { return measure_.error(mesh, trial.normals, e, distance); };
  for (EdgeId e : candidates) {
    errors[e] = error(e, trial.deviation_bound(mesh, e));
    if (errors[e] >= threshold) errors[e] = error(e, trial.deviation_at(mesh, e));
  }
  return errors;
}

}  // namespace papilio
