#include "tests/bench/equal_size.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace papilio::bench {
namespace {

constexpr int steps = 18;

/// Bisects a parameter that decreases the number of faces. Returns the best result of all steps by `is_better(a, b)`,
/// which compares numbers of faces.
TriangleMesh bisect(double finest, double coarsest, size_t faces, const std::function<TriangleMesh(double)>& result_of,
                    const std::function<bool(size_t, size_t)>& is_better) {
  TriangleMesh best;
  for (int step = 0; step < steps; ++step) {
    const double middle = (finest + coarsest) / 2;
    TriangleMesh result = result_of(middle);
    const size_t count = result.triangles.size();
    (count > faces ? finest : coarsest) = middle;
    if (step == 0 || is_better(count, best.triangles.size())) best = std::move(result);
    if (count == faces) break;
  }
  return best;
}

}  // namespace

std::vector<double> scaled_thresholds(std::vector<double> thresholds, double factor) {
  for (double& t : thresholds) t = std::cos(std::min(factor * std::acos(t), std::numbers::pi));
  return thresholds;
}

TriangleMesh flatness_result(const Mesh& coarse, const Options& options, size_t faces) {
  const auto off_by = [faces](size_t count) { return count > faces ? count - faces : faces - count; };
  return bisect(
      0, 4, faces,
      [&](double factor) {
        Options scaled = options;
        scaled.flatness = scaled_thresholds(options.flatness, factor);
        return refine(coarse, scaled).mesh.triangles();
      },
      [&](size_t a, size_t b) { return off_by(a) < off_by(b); });
}

TriangleMesh tolerance_result(const Mesh& coarse, Options options, size_t faces) {
  options.flatness.clear();
  return bisect(
      -7, 0, faces,
      [&](double exponent) {
        options.tolerance = std::pow(10, exponent);
        return refine(coarse, options).mesh.triangles();
      },
      [&](size_t a, size_t b) { return b > faces ? a < b : a <= faces && a > b; });
}

}  // namespace papilio::bench
