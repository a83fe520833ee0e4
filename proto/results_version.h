#pragma once

#include <string>

namespace papilio::proto {

/// Raised by whoever changes any byte of an encoded result, or what a default means, where results of the core stay the
/// same. A test holds it against recorded bytes (tests/unit/recorded_results_test.cpp).
inline constexpr int encoding_version = 2;

/// Names all that the bytes of a result depend on besides the mesh and the parameters: the versions of the algorithm
/// and the encoding, and those of the libraries that simplify and encode.
[[nodiscard]] std::string results_version();

}  // namespace papilio::proto
