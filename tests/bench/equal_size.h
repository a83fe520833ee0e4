#pragma once

#include "papilio/refine.h"

// Results of a target size: one parameter of the refinement is bisected to match the number of faces.

namespace papilio::bench {

/// Returns the thresholds for edges `factor` times as sharp: cos(factor * acos(t)), at most 180 degrees. Above 1 is
/// coarser.
[[nodiscard]] std::vector<double> scaled_thresholds(std::vector<double> thresholds, double factor);

/// Returns the result by flatness closest to `faces`: the thresholds of `options` are scaled.
[[nodiscard]] TriangleMesh flatness_result(const Mesh& coarse, const Options& options, size_t faces);

/// Returns the largest result by tolerance, without thresholds, of at most `faces`; the smallest result if there is
/// none.
[[nodiscard]] TriangleMesh tolerance_result(const Mesh& coarse, Options options, size_t faces);

}  // namespace papilio::bench
