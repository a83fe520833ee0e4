#pragma once

#include "server/config.h"

namespace papilio::server {

inline constexpr uint64_t stack_bytes = 8ULL << 20;  ///< of a thread
inline constexpr bool is_sanitized =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    true;
#else
    false;
#endif

/// Without so much the threads could not even start.
[[nodiscard]] uint64_t address_space_of_threads(const Config& config);
/// What the settings together may need, with room to spare: bodies, slots, caches, the store, a stack a thread.
[[nodiscard]] uint64_t address_space_needed(const Config& config);

/// Bounds the address space of the process (RLIMIT_AS), so that a mesh which takes more memory than any limit foresaw
/// fails for itself (std::bad_alloc) and not the machine. Not under a sanitizer, whose shadow memory needs terabytes.
/// Throws std::runtime_error when the setting cannot be applied.
void limit_address_space(const Config& config);

}  // namespace papilio::server
