#pragma once

#include "papilio/refine.h"

// Results of a wanted size: one parameter of the refinement is bisected until the number of faces fits.

namespace papilio::bench {

/// The thresholds for edges `factor` times as sharp: cos(factor * acos(t)), at most 180 degrees. Above 1 is coarser.
[[nodiscard]] std::vector<double> scaled_thresholds(std::vector<double> thresholds, double factor);

/// By flatness: the thresholds of `options` scaled by what brings the result closest to `faces`.
[[nodiscard]] TriangleMesh flatness_result(const Mesh& coarse, const Options& options, size_t faces);

/// By tolerance alone, without thresholds: the largest result of at most `faces`; if there is none, the smallest.
[[nodiscard]] TriangleMesh tolerance_result(const Mesh& coarse, Options options, size_t faces);

}  // namespace papilio::bench
