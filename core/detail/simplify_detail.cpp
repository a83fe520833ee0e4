#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/poller.h"
#include "detail/optimal_collapse.h"
#include "detail/step_search.h"
#include "detail/surface_distance.h"
#include "detail/vertex_fit.h"
#include "papilio/detail.h"
#include "papilio/error.h"

namespace papilio {
namespace {

/// Factor between the sizes of candidates.
constexpr double ratio_of_sizes = 0.87;
constexpr size_t fewest_faces = 12;
/// RMS distance of the first candidate, in target distances: its vertices are moved nearer.
constexpr double first_rms = 1.1;
/// Upper bound of a candidate's RMS distance before its vertices are rounded, in target distances.
constexpr double largest_floor = 0.97;
/// The search for a size ends after so many in a row that take more bytes.
constexpr int most_worse_sizes = 2;
/// Upper bound of the sizes looked at, as meshes that are too far after all cost time, too.
constexpr int most_sizes = 8;
/// Step of the grid to start with, in target distances, attempts to find it, and the share of the target distance that
/// ends the search.
constexpr double first_grid_step = 5;
constexpr int step_attempts = 5;
constexpr double near_share = 0.985;
/// Factor of a step that leaves the RMS distance, but not the largest one.
constexpr double step_of_farther = 0.7;
constexpr int most_bits = 20;
/// Upper bound of the distances that collapses leave, a share of the largest allowed: rounding moves vertices, too.
constexpr double share_of_largest = 0.8;
/// The same for moved vertices.
constexpr double share_after_fit = 0.9;
constexpr int passes_of_fit = 2;
/// Samples of a fit, per face, and their bounds.
constexpr uint32_t fit_samples_a_face = 6, least_fit_samples = 20'000, most_fit_samples = 400'000;
constexpr uint32_t few_samples = 20'000, many_samples = 60'000;

class Simplification {
 public:
  Simplification(const TriangleMesh& original, const SimplifyOptions& options, const MeshCoder& code)
      : poller_([&options] {
          if (options.cancelled && options.cancelled()) throw Error(Fault::cancelled, "Simplification was cancelled.");
        }),
        code_(code),
        tree_(build_mesh(original).triangles()),
        box_(bounding_box(tree_.surface().positions)),
        wanted_(options.rms * box_.diagonal()),
        most_(options.largest * box_.diagonal()) {}

  std::optional<SimplifiedDetail> run() {
    std::vector<size_t> sizes;
    size_t faces = tree_.surface().triangles.size();
    while (faces >= fewest_faces) {
      sizes.push_back(faces);
      faces = static_cast<size_t>(ratio_of_sizes * static_cast<double>(faces));
    }
    const std::vector<TriangleMesh> meshes =
        collapse_to_sizes(tree_.surface(), sizes, Quadrics::memoryless, poller_, share_of_largest * most_);
    // Finds the first size that is too far; distances are nearly ascending.
    const auto first_beyond = std::ranges::partition_point(
        meshes, [&](const TriangleMesh& mesh) { return distance_to(mesh, few_samples).rms <= first_rms * wanted_; });
    std::optional<SimplifiedDetail> best;
    int worse = 0;
    auto mesh = first_beyond;
    for (int sizes_tried = 0; mesh != meshes.begin() && worse < most_worse_sizes && sizes_tried < most_sizes;
         ++sizes_tried) {
      std::optional<SimplifiedDetail> made = on_coarsest_grid(*--mesh);
      if (!made) continue;
      const bool is_best = !best || made->bytes < best->bytes;
      worse = is_best ? 0 : worse + 1;
      if (is_best) best = std::move(made);
    }
    return best;
  }

 private:
  [[nodiscard]] SurfaceDistance distance_to(const TriangleMesh& mesh, uint32_t samples) const {
    poller_.now();
    const SurfaceTree surface(mesh);
    SurfaceDistance distance = surface_distance(tree_, surface, samples, poller_);
    if (is_near(distance)) distance.largest = std::max(distance.largest, vertex_distance(tree_, surface, poller_));
    return distance;
  }

  [[nodiscard]] bool is_near(const SurfaceDistance& distance) const {
    return distance.rms <= wanted_ && distance.largest <= most_;
  }

  /// Moves the vertices of a mesh, and codes it on the coarsest grid found that leaves the target distance.
  [[nodiscard]] std::optional<SimplifiedDetail> on_coarsest_grid(const TriangleMesh& mesh) const {
    const auto faces = static_cast<uint32_t>(mesh.triangles.size());
    VertexFit fit(tree_, mesh, std::clamp(fit_samples_a_face * faces, least_fit_samples, most_fit_samples), poller_);
    fit.improve(passes_of_fit);
    SurfaceDistance floor = distance_to(fit.mesh(), many_samples);
    if (floor.rms <= largest_floor * wanted_ && floor.largest > most_) {
      fit.retreat(share_after_fit * most_);
      floor = distance_to(fit.mesh(), many_samples);
    }
    if (floor.rms > largest_floor * wanted_ || floor.largest > most_) return std::nullopt;
    std::optional<TriangleMesh> best;
    PositionGrid best_grid;
    double step = first_grid_step * wanted_;
    for (int i = 0; i < step_attempts; ++i) {
      const std::optional<PositionGrid> grid = grid_of(step);
      if (!grid) break;
      TriangleMesh rounded = fit.on_grid(*grid);
      const SurfaceDistance distance = distance_to(rounded, many_samples);
      if (is_near(distance) && (!best || grid->step > best_grid.step)) {
        best = std::move(rounded);
        best_grid = *grid;
      }
      if (is_near(distance) && distance.rms >= near_share * wanted_) break;
      const double next = expected_step(step, distance.rms, floor.rms, wanted_);
      step = distance.rms <= wanted_ && distance.largest > most_ ? step_of_farther * step : next;
    }
    if (!best) return std::nullopt;
    return coded(*best, best_grid);
  }

  /// Returns the grid of a step whose origin is the lowest corner of the original's box; nothing if it is too fine.
  [[nodiscard]] std::optional<PositionGrid> grid_of(double step) const {
    const Vec3d size = to_double(box_.max) - to_double(box_.min);
    const double longest = std::max({size.x, size.y, size.z});
    int bits = 1;
    while (bits <= most_bits && (std::exp2(bits) - 1) * step < longest) ++bits;
    if (bits > most_bits) return std::nullopt;
    return PositionGrid{box_.min, static_cast<float>(step), bits};
  }

  /// Returns nothing if the decoded mesh is farther, as faces without area are lost.
  [[nodiscard]] std::optional<SimplifiedDetail> coded(const TriangleMesh& rounded, const PositionGrid& grid) const {
    CodedBase coded = code_(rounded, grid);
    if (coded.triangles.triangles.empty()) return std::nullopt;
    const SurfaceDistance distance = distance_to(coded.triangles, many_samples);
    if (!is_near(distance)) return std::nullopt;
    const double diagonal = box_.diagonal();
    return SimplifiedDetail{
        std::move(coded.triangles), {distance.rms / diagonal, distance.largest / diagonal}, coded.bytes, grid};
  }

  Poller poller_;
  const MeshCoder& code_;
  SurfaceTree tree_;  // original
  Box box_;
  double wanted_, most_;  // RMS and largest distance, in the mesh's unit
};

}  // namespace

std::optional<SimplifiedDetail> simplify_detail(const TriangleMesh& original, const SimplifyOptions& options,
                                                const MeshCoder& code) {
  if (!(options.rms >= 1e-6 && options.rms <= 0.1))
    throw Error(Fault::bad_option, "The distance must be 1e-6 to 0.1 of the diagonal.", "rms");
  if (!(options.largest > 0)) throw Error(Fault::bad_option, "The largest distance must be above 0.", "largest");
  return Simplification(original, options, code).run();
}

}  // namespace papilio
