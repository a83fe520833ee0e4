#pragma once

#include "server/config.h"

namespace papilio::server {

/// Without so much the threads could not even start.
[[nodiscard]] uint64_t address_space_of_threads(const Config& config);
/// What the settings together may need, with room to spare: bodies, slots, caches, the store, a stack a thread.
[[nodiscard]] uint64_t address_space_needed(const Config& config);

/// --max-memory-bytes, or else what the settings together may need, and no more than the container's memory beside the
/// stacks, most of which are never touched: a mesh too large for it is refused before the container is killed for it.
[[nodiscard]] uint64_t address_space_bound(const Config& config);

/// Bounds the address space of the process (RLIMIT_AS), so that a mesh which takes more memory than any limit foresaw
/// fails for itself (std::bad_alloc) and not the machine. Not under a sanitizer, whose shadow memory needs terabytes.
/// Throws std::runtime_error when the setting cannot be applied.
void limit_address_space(const Config& config);

}  // namespace papilio::server
