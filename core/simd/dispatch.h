#pragma once

// On x86-64 some loops are compiled twice: for every processor, and for those that have AVX2. Which one runs is decided
// when it runs. Both give the same bits.

namespace papilio {

/// Forbids AVX2, or allows it again where the processor has it: for tests of what other processors do.
void allow_avx2(bool allowed);

/// Behind the parameters of a lambda: inlines it, so that it is compiled for the processor that its caller is.
#define PAPILIO_INLINED __attribute__((always_inline))

#if defined(__x86_64__)
#define PAPILIO_AVX2 gnu::target("avx2")

/// Whether the processor has AVX2 and it is allowed.
[[nodiscard]] bool has_avx2();

template <class Work>
[[PAPILIO_AVX2]] void run_with_avx2(const Work& work) {
  work();
}
#endif

/// Runs work(), an inlined lambda, with the widest instructions that there are.
template <class Work>
void run_wide(const Work& work) {
#if defined(__x86_64__)
  if (has_avx2()) return run_with_avx2(work);
#endif
  work();
}

}  // namespace papilio
