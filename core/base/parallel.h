#pragma once

#include <cstdint>
#include <functional>

namespace papilio {

#if defined(__wasm__)  // whose standard library has none
inline constexpr bool has_threads = false;
#else
inline constexpr bool has_threads = true;
#endif

/// So few are not worth a thread.
inline constexpr uint32_t least_per_thread = 1U << 13;

/// How many of at most `threads` threads are worth their start for `count` things.
[[nodiscard]] uint32_t parts_of(uint32_t count, int threads);

/// Cuts 0 to count - 1 into `parts` ranges of about equal length, in ascending order, and calls work(part, first, last)
/// for each, with one past its last: the first on the calling thread, the others beside it, or after it where the
/// system has no more threads. Returns when all are done; throws what the lowest part that failed has thrown.
void for_each_part(uint32_t parts, uint32_t count, const std::function<void(uint32_t, uint32_t, uint32_t)>& work);

}  // namespace papilio
