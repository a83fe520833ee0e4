#pragma once

#include <cstdint>

namespace papilio::proto {

/// Lower bound of the bytes whose return to the system pays off.
inline constexpr uint64_t worth_giving_back = uint64_t{1} << 20;

/// Returns free pages of the heap to the system. Takes about a millisecond.
void trim_heap();
/// Returns freed memory to the system: free pages of the heap, and the core's spare blocks.
void give_back_freed();

/// Returns `bytes` of the core's spare blocks to the system, as other arrays are about to take as much: no more, as
/// fresh pages are slow. If fewer are spare, trims the heap too.
void make_room(uint64_t bytes);

}  // namespace papilio::proto
