#pragma once

namespace papilio {

/// Raised by whoever changes any bit of any result of refine(). Caches of results depend on it. A test holds it against
/// recorded results (tests/unit/recorded_results_test.cpp).
inline constexpr int algorithm_version = 5;

/// Of the simplifier library behind `simplify_hidden`: other versions may give other meshes.
[[nodiscard]] int simplifier_version();

}  // namespace papilio
