#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/detail/optimal_collapse.h"
#include "papilio/mesh.h"
#include "tests/support/rate_curve.h"
#include "tests/support/sampled_distance.h"

// Alternatives to Papilio's detail: the original as Draco, or a simplified original as Draco.

namespace papilio::test {

/// A model to be sent, without attributes; points of equal position are welded.
struct DetailSubject {
  DetailSubject(std::string name, const TriangleMesh& mesh, size_t samples = SampledSurface::default_samples);

  std::string name;
  TriangleMesh original;
  SampledSurface surface;
};

/// A method to send a model, at several sizes.
struct DetailMethod {
  std::string name;
  std::function<std::vector<RatePoint>(const DetailSubject&)> points;
};

/// RMS distances that points should cover, in percent of the diagonal: slightly more than the compared range.
inline constexpr double coarsest_rms = 0.08, finest_rms = 0.003;

/// Returns the smallest Draco stream of the mesh at these bits per coordinate in its bounding cube: of the speeds 0 and
/// 3, with and without the faces that lose their area by quantization.
[[nodiscard]] std::string smallest_draco(const TriangleMesh& mesh, int position_bits);

/// Measures the decoded mesh of a Draco stream.
[[nodiscard]] RatePoint rate_point(const DetailSubject& subject, const std::string& draco, int position_bits);

/// Returns face counts from the original's down to `least`, each `ratio` times the one before.
[[nodiscard]] std::vector<size_t> size_ladder(size_t faces, double ratio = 0.8, size_t least = 60);

/// Whole original at 8 to 16 bits a coordinate.
[[nodiscard]] std::vector<RatePoint> plain_draco(const DetailSubject& subject);
/// meshoptimizer's edge collapse onto existing vertices, then Draco.
[[nodiscard]] std::vector<RatePoint> meshoptimizer_and_draco(const DetailSubject& subject);
/// `collapse_to_sizes`, then Draco.
[[nodiscard]] std::vector<RatePoint> quadrics_and_draco(const DetailSubject& subject, Quadrics quadrics);

/// The methods above, with both kinds of quadrics.
[[nodiscard]] std::vector<DetailMethod> detail_baselines();

}  // namespace papilio::test
