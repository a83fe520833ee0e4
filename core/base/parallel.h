#pragma once

#include <cstdint>
#include <functional>

namespace papilio {

#if defined(__wasm__)  // its standard library has no threads
inline constexpr bool has_threads = false;
#else
inline constexpr bool has_threads = true;
#endif

/// Lower bound of the items per thread: fewer do not pay for its start.
inline constexpr uint32_t least_per_thread = 1U << 13;

/// Returns the number of threads, at most `threads`, that pays off for `count` items.
[[nodiscard]] uint32_t parts_of(uint32_t count, int threads);

/// Divides [0, count) into `parts` ascending ranges of about equal length, and calls work(part, begin, end) for each.
/// The first runs on the calling thread, the others on threads of their own, or after it if the system provides no
/// more. Returns when all are done. Rethrows the exception of the lowest part that failed.
void for_each_part(uint32_t parts, uint32_t count, const std::function<void(uint32_t, uint32_t, uint32_t)>& work);

}  // namespace papilio
