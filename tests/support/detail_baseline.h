#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/detail/optimal_collapse.h"
#include "papilio/mesh.h"
#include "tests/support/rate_curve.h"
#include "tests/support/sampled_distance.h"

// What a sender has without Papilio's detail: the original as Draco, or a simplified original as Draco.

namespace papilio::test {

/// A model to be sent: vertices of equal position are one, without attributes.
struct DetailSubject {
  DetailSubject(std::string name, const TriangleMesh& mesh, size_t samples = SampledSurface::default_samples);

  std::string name;
  TriangleMesh original;
  SampledSurface surface;
};

/// One way to send a model, at as many sizes as give a curve.
struct DetailMethod {
  std::string name;
  std::function<std::vector<RatePoint>(const DetailSubject&)> points;
};

/// RMS distances that points should cover, in percent of the diagonal: somewhat more than the range compared.
inline constexpr double coarsest_rms = 0.08, finest_rms = 0.003;

/// Smallest Draco stream of the mesh at so many bits a coordinate, in the mesh's own bounding cube: of the speeds 0
/// and 3, with and without the faces that quantization leaves without area.
[[nodiscard]] std::string smallest_draco(const TriangleMesh& mesh, int position_bits);

/// Measures the mesh that arrives as a Draco stream.
[[nodiscard]] RatePoint rate_point(const DetailSubject& subject, const std::string& draco, int position_bits);

/// Face counts from that of the original down to `least`, each `ratio` times the one before.
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
