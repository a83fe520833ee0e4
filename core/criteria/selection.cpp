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
#include "rules/tension.h"
#include "rules/uniform_butterfly.h"

namespace papilio {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float never = -infinity;

/// No less than the number, which is not negative.
float rounded_up(double number) { return static_cast<float>(1.000001 * number + std::numeric_limits<float>::min()); }

/// Writes those of the edges that are complete.
void make_vertices_by_w(const Mesh& mesh, const TensionField* tension, double w, const TrialContext& context,
                        Vec3f* made) {
  const uint32_t edges = mesh.topology.edge_count();
  const SplitPlan plan(context.complete == nullptr ? EdgeMarks(edges, 1) : *context.complete);
  const Buffer<Vec3f> planned = butterfly(mesh.topology, mesh.positions, plan, static_cast<float>(w), tension);
  for (uint32_t e = 0; e < edges; ++e)
    if (plan.is_split(e)) made[e] = planned[plan.before[e]];
}

void make_plain_vertices(const Mesh& mesh, const TensionField* tension, const TrialContext& context, Vec3f* made) {
  const Vec3f* positions = mesh.positions.data();
  const Topology* topology = mesh.topology.origin.empty() ? nullptr : &mesh.topology;
  std::optional<Features> found;
  if (context.features == nullptr) found = find_features(*topology);
  const Features& features = found ? *found : *context.features;
  if (tension != nullptr || context.parents == nullptr)
    uniform_butterfly(*topology, features, positions, made, tension, context.threads);
  else if (context.part != nullptr)
    uniform_butterfly_below(*context.parents, *context.part, features, positions, made, context.threads);
  else
    uniform_butterfly_below(*context.parents, topology, features, positions, made, context.threads, context.asked_of);
}

Buffer<Vec3f> normals_asked_of(const Mesh& mesh, const Options& options, const TrialContext& context) {
  return face_normals(mesh, context.threads, options.tension == Tension::off ? context.normals_of : nullptr);
}

}  // namespace

void make_vertices(const Mesh& mesh, const Buffer<Vec3f>& normals, const Options& options, const TrialContext& context,
                   Vec3f* made) {
  std::optional<TensionField> field;
  if (options.tension != Tension::off) field = tension_field(mesh, normals, options.tension);
  const TensionField* tension = field ? &*field : nullptr;
  if (options.w != 0)
    make_vertices_by_w(mesh, tension, options.w, context, made);
  else
    make_plain_vertices(mesh, tension, context, made);
}

Trial try_split(const Mesh& mesh, const Options& options, const TrialContext& context) {
  Trial trial{.normals = normals_asked_of(mesh, options, context)};
  trial.made.resize_for_overwrite(mesh.topology.edge_count());
  make_vertices(mesh, trial.normals, options, context, trial.made.data());
  trial.is_of_some = context.asked_of != nullptr || context.part != nullptr;
  return trial;
}

void Trial::forget() {
  deviations = LazyValues<double>(made.size(), unknown);
  bounds = LazyValues<float>(made.size(), infinity);
}

void Trial::prepare_errors(const Mesh& mesh, const Options& options, const TrialContext& context) {
  const bool has_tolerance = options.tolerance > 0 || (options.view && options.view->error_pixels > 0);
  if (!has_tolerance && options.max_faces == 0) return;
  forget();
  if (!has_tolerance) return;
  rooms = rooms_at_sides(mesh, context.normals_of, context.threads);
  least = LazyValues<float>(made.size(), 0);
}

void Trial::find_ranges(const Mesh& mesh, std::span<const uint32_t> edges) const {
  const DeviationBounds finder{mesh, normals, rooms, made};
  for (size_t first = 0; first < edges.size(); first += 4) {
    std::array<uint32_t, 4> four{};
    for (size_t i = 0; i < 4; ++i) four[i] = edges[std::min(first + i, edges.size() - 1)];
    const std::array<DeviationRange, 4> ranges = finder.find(four);
    for (size_t i = 0; i < 4; ++i) {
      bounds.put(four[i], ranges[i].most);
      least.put(four[i], ranges[i].least);
    }
  }
}

void Trial::keep(const Topology& mesh) {
  forget();
  products = NormalProducts(mesh.edge_count(), infinity);
  is_kept = true;
}

double Trial::most_deviation_at(const Mesh& mesh, uint32_t edge) const {
  float known = no_less_than_deviation_at(edge);
  if (known != infinity) return known;
  known = rounded_up(std::sqrt(squared_offset(mesh, edge)));
  if (!bounds.empty()) bounds.put(edge, known);
  return known;
}

double Trial::deviation_at(const Mesh& mesh, uint32_t edge) const {
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

bool Selection::is_by_error() const {
  return options_.tolerance > 0 || options_.max_faces > 0 || (options_.view && options_.view->error_pixels > 0);
}

double Selection::flatness_of(int level) const {
  const auto index = static_cast<size_t>(level - 1);
  return index < options_.flatness.size() ? options_.flatness[index] : options_.flatness.back();
}

float Selection::error_of(const Mesh& mesh, const Trial& trial, uint32_t edge, double distance) const {
  return measure_.grows_with_distance() ? measure_.error(mesh, trial.normals, edge, distance) : infinity;
}

bool Selection::later_level_is_finer(int level) const {
  if (options_.flatness.empty()) return false;
  for (int later = level + 1; later <= options_.levels; ++later)
    if (flatness_of(later) > flatness_of(level)) return true;
  return false;
}

EdgesShown Selection::shown(const Mesh& mesh, const Trial& trial, const Buffer<double>& longest, const Box& box,
                            const Buffer<uint32_t>& shared) const {
  if (!camera_) return {};
  return {mesh, trial.normals, longest, box, *camera_, shared};
}

Buffer<uint32_t> Selection::curved(const Mesh& mesh, const Trial& trial, int level, const Region& region) const {
  if (options_.flatness.empty()) return region.edges();
  return marked(find_curved(mesh, trial.normals, trial.products, flatness_of(level), options_.growth, region));
}

Buffer<uint32_t> Selection::wanted(const Mesh& mesh, const Trial& trial, int level, const Region& region,
                                   const EdgesShown& shown, const Box& box, float least) const {
  Buffer<uint32_t> edges = curved(mesh, trial, level, region);
  const double needed = is_by_error() ? measure_.least_deviation(least, highest_pixels_per_unit(box)) : 0;
  if (needed > 0) {
    if (trial.has_ranges()) trial.find_ranges(mesh, edges);
    keep_if(edges, [&](uint32_t e) { return trial.no_less_than_deviation_at(e) >= needed; });
    if (!trial.has_ranges()) keep_if(edges, [&](uint32_t e) { return trial.most_deviation_at(mesh, e) >= needed; });
    // Where more views are to come, the deviation itself serves all of them, whether this one shows the edge or not.
    if (trial.is_kept) keep_if(edges, [&](uint32_t e) { return trial.deviation_at(mesh, e) >= needed; });
  }
  shown.keep_shown(region, edges);
  if (camera_) keep_long(mesh, *camera_, options_.view->edge_pixels, edges);
  return edges;
}

bool Selection::is_kept_by_view(const Mesh& mesh, const EdgesShown& shown, uint32_t edge) const {
  return camera_ && (!shown[edge] || !is_long(mesh, *camera_, options_.view->edge_pixels, edge));
}

bool Selection::may_have_long_halves(const Mesh& mesh, uint32_t edge) const {
  constexpr double least = 1.5;  // of what a half must have
  return !camera_ || is_long(mesh, *camera_, least * options_.view->edge_pixels, edge);
}

Buffer<float> Selection::errors(const Mesh& mesh, const Trial& trial, const Buffer<uint32_t>& wanted, const Box& box,
                                float threshold, Reaching reaching) const {
  Buffer<float> errors(mesh.topology.edge_count(), never);
  const double scale = highest_pixels_per_unit(box);
  const bool least_will_do = reaching == Reaching::no_more && trial.has_ranges() && measure_.grows_with_distance();
  const auto error = [&](uint32_t e, double distance) { return measure_.error(mesh, trial.normals, e, distance); };
  for (uint32_t e : wanted) {
    const double most = trial.most_deviation_at(mesh, e);
    errors[e] = measure_.most_error(most, scale);
    if (errors[e] < threshold) continue;
    errors[e] = error(e, most);
    if (errors[e] < threshold) continue;
    if (least_will_do) {
      errors[e] = error(e, trial.no_more_than_deviation_at(e));
      if (errors[e] >= threshold) continue;
    }
    errors[e] = error(e, trial.deviation_at(mesh, e));
  }
  return errors;
}

}  // namespace papilio
