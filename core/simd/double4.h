#pragma once

#if defined(__x86_64__)
#include <immintrin.h>

#include "simd/dispatch.h"
#include "simd/float4.h"

namespace papilio {

/// Four doubles in a register, for functions compiled for AVX2 (dispatch.h). Whoever uses it has a twin that gives the
/// same bits on other processors.
using Double4 = double __attribute__((vector_size(32)));

/// Writes the square root of each.
[[PAPILIO_AVX2, gnu::always_inline]] inline void find_roots(const Double4& of, Double4& roots) {
  roots = _mm256_sqrt_pd(of);
}
[[PAPILIO_AVX2, gnu::always_inline]] inline Double4 to_double4(Float4 a) { return _mm256_cvtps_pd(a); }
[[PAPILIO_AVX2, gnu::always_inline]] inline Float4 to_float4(const Double4& a) { return _mm256_cvtpd_ps(a); }

}  // namespace papilio
#endif
