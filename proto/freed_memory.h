#pragma once

#include <cstdint>

namespace papilio::proto {

/// Bytes from which on memory matters more than the time to give it back.
inline constexpr uint64_t worth_giving_back = uint64_t{1} << 20;

/// Gives free pages of the heap back to the system. Takes about a millisecond.
void trim_heap();
/// Gives freed memory back to the system: free pages of the heap, and blocks that the core keeps for later.
void give_back_freed();

/// Gives back so many bytes of the blocks that the core keeps for later, as other arrays now take them: no more, as
/// they take long to get again. Where fewer are kept, the heap gives back too.
void make_room(uint64_t bytes);

}  // namespace papilio::proto
