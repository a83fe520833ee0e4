#pragma once

#include <string>

namespace papilio::proto {

/// Version of encoded bytes and of the meaning of defaults. Increment it with any change of either that leaves results
/// of the core unchanged. tests/unit/recorded_results_test.cpp checks it against recorded bytes.
inline constexpr int encoding_version = 5;

/// Returns all versions that the bytes of a result depend on: algorithm, encoding, meshoptimizer and libdraco.
[[nodiscard]] std::string results_version();

}  // namespace papilio::proto
