#pragma once

namespace papilio {

/// Version of the results of refine(): increment it when any bit of any result changes. Caches of results depend on it.
/// A test checks it against recorded results (tests/unit/recorded_results_test.cpp).
inline constexpr int algorithm_version = 15;

/// Returns the version of the simplifier library behind `simplify_hidden`: its versions may differ in their results.
[[nodiscard]] int simplifier_version();

}  // namespace papilio
