#include "selection.h"

#include <algorithm>
#include <limits>

#include "butterfly.h"
#include "normals.h"

namespace papilio {
namespace {

constexpr float never = -std::numeric_limits<float>::infinity();

/// Never less than the deviation: the midpoint is on the surface.
double distance_to_midpoint(const Mesh& mesh, uint32_t edge, Vec3f q) {
  const uint32_t h = mesh.topology.half_edge[edge];
  const Vec3d ends =
      to_double(mesh.positions[mesh.topology.origin[h]]) + to_double(mesh.positions[mesh.topology.tip(h)]);
  return length(to_double(q) - 0.5 * ends);
}

}  // namespace

Trial try_split(const Mesh& mesh, const Options& options, const EdgeMarks& try_edges) {
  Trial trial{.normals = face_normals(mesh), .tried = SplitPlan(try_edges), .made = {}};
  const auto w = static_cast<float>(options.w);
  if (options.tension == Tension::off) {
    trial.made = butterfly(mesh.topology, mesh.positions, trial.tried, w);
  } else {
    const TensionField field = tension_field(mesh.topology, trial.normals, options.tension);
    trial.made = butterfly(mesh.topology, mesh.positions, trial.tried, w, &field);
  }
  return trial;
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

bool Selection::later_level_is_finer(int level) const {
  if (options_.flatness.empty()) return false;
  for (int later = level + 1; later <= options_.levels; ++later)
    if (flatness_of(later) > flatness_of(level)) return true;
  return false;
}

void Selection::narrow(const Mesh& mesh, const std::vector<Vec3f>& normals, int level, EdgeMarks& marks) const {
  if (!options_.flatness.empty()) {
    EdgeMarks curved(marks.size(), 0);
    mark_by_flatness(mesh, normals, flatness_of(level), curved);
    for (size_t e = 0; e < marks.size(); ++e) curved[e] &= marks[e];
    grow(mesh.topology, options_.growth, curved);
    for (size_t e = 0; e < marks.size(); ++e) marks[e] &= curved[e];
  }
  if (camera_) cull_by_view(mesh, normals, *camera_, options_.view->edge_pixels, marks);
}

void Selection::cull_unseen(const Mesh& mesh, const std::vector<Vec3f>& normals, EdgeMarks& marks) const {
  if (camera_) cull_by_view(mesh, normals, *camera_, 0, marks);
}

std::vector<float> Selection::errors(const Mesh& mesh, const Trial& trial, const EdgeMarks& marks,
                                     float exact_from) const {
  std::vector<float> errors(marks.size(), never);
  for (uint32_t e = 0; e < marks.size(); ++e) {
    if (marks[e] == 0) continue;
    errors[e] = measure_.error(mesh, trial.normals, e, distance_to_midpoint(mesh, e, trial.at(e)));
    if (errors[e] >= exact_from) errors[e] = measure_.error(mesh, trial.normals, e, deviation(mesh, e, trial.at(e)));
  }
  return errors;
}

void ErrorLeft::add(const Mesh& mesh, uint32_t edge, Vec3f q, double share) {
  const double most = share * distance_to_midpoint(mesh, edge, q);
  if (most <= distance_ && measure_.pixels(mesh, edge, most) <= pixels_) return;
  const double distance = share * deviation(mesh, edge, q);
  distance_ = std::max(distance_, distance);
  pixels_ = std::max(pixels_, measure_.pixels(mesh, edge, distance));
}

void append_edges(const Topology& mesh, const std::vector<float>& errors, std::vector<WeighedEdge>& edges) {
  const size_t begin = edges.size();
  edges.resize(begin + errors.size());
  for (size_t e = 0; e < errors.size(); ++e) edges[begin + e] = {errors[e], 0};
  for (uint32_t e : mesh.edge) ++edges[begin + e].faces;
}

float threshold_within(std::vector<WeighedEdge> edges, float least, uint64_t faces, uint64_t budget) {
  std::erase_if(edges, [&](const WeighedEdge& e) { return !(e.error >= least); });
  for (const WeighedEdge& e : edges) faces += e.faces;
  if (faces <= budget) return least;
  std::ranges::sort(edges, {}, &WeighedEdge::error);
  // Equal errors go together: what forces each other has one error.
  for (size_t i = 0; i < edges.size();) {
    const float error = edges[i].error;
    for (; i < edges.size() && edges[i].error == error; ++i) faces -= edges[i].faces;
    if (faces <= budget) return i < edges.size() ? edges[i].error : std::numeric_limits<float>::infinity();
  }
  return std::numeric_limits<float>::infinity();
}

}  // namespace papilio
