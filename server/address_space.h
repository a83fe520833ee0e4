#pragma once

#include "server/config.h"

namespace papilio::server {

inline constexpr uint64_t stack_bytes = 8ULL << 20;  ///< stack of a thread
inline constexpr bool is_sanitized =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    true;
#else
    false;
#endif

/// Returns the address space that threads require to start.
[[nodiscard]] uint64_t address_space_of_threads(const Config& config);
/// Returns a generous upper bound of the address space for the settings: bodies, slots, caches, store, and stacks.
[[nodiscard]] uint64_t address_space_needed(const Config& config);

/// Limits the address space of the process (RLIMIT_AS), so that a mesh of unforeseen memory fails alone
/// (std::bad_alloc) and does not exhaust the machine. Has no effect under a sanitizer, whose shadow memory takes
/// terabytes. Throws std::runtime_error if the limit cannot be applied.
void limit_address_space(const Config& config);

}  // namespace papilio::server
