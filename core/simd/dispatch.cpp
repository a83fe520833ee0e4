#include "simd/dispatch.h"

#include <atomic>

namespace papilio {
namespace {

std::atomic<bool> is_avx2_allowed{true};

}  // namespace

void allow_avx2(bool allowed) { is_avx2_allowed = allowed; }

#if defined(__x86_64__)
bool has_avx2() { return __builtin_cpu_supports("avx2") != 0 && is_avx2_allowed.load(std::memory_order_relaxed); }
#endif

}  // namespace papilio
