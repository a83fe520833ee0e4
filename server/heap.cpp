#include "server/heap.h"

#include <malloc.h>

#include <algorithm>
#include <new>
#include <utility>

#include "papilio/buffer.h"

namespace papilio::server {
namespace {

constexpr int largest_block = 32 << 20;    ///< upper bound of blocks in arenas, glibc's maximum; larger ones are mapped
constexpr int kept_at_end = 64 << 20;      ///< bytes retained at the end of each arena, as glibc itself would
constexpr int most_calls = 5;              ///< upper bound of calls without a return while requests are done
constexpr size_t block_bytes = 128 << 10;  ///< size at which glibc trims the arena's end when a block is freed

/// Releases the core's spare blocks when memory is short, so that `new` can try again.
void give_up_spares() {
  if (spare_bytes() == 0) throw std::bad_alloc();
  release_spare_blocks();
}

}  // namespace

void set_up_heap(int slots) {
  std::set_new_handler(give_up_spares);
  mallopt(M_ARENA_MAX, std::max(2, slots));
  mallopt(M_MMAP_THRESHOLD, largest_block);
  mallopt(M_TRIM_THRESHOLD, kept_at_end);
}

// malloc_trim returns free memory within arenas, but the free end of the main arena only. The end of another arena is
// returned when a block of that arena is freed, on any thread; so each thread leaves a block.

void FreeMemory::count_request() {
  thread_local uint64_t left_in = 0;  // round of the last block; a thread works for one server
  const std::lock_guard lock(mutex_);
  ++done_;
  if (left_in == round_) return;
  left_in = round_;
  try {
    std::vector<char> block;
    block.reserve(block_bytes);  // not written to: only its first page takes memory
    blocks_.push_back(std::move(block));
  } catch (const std::bad_alloc&) {
    // The end of this arena is returned in another round.
  }
}

void FreeMemory::give_back() {
  std::vector<std::vector<char>> blocks;
  {
    const std::lock_guard lock(mutex_);
    const bool quiet = done_ == std::exchange(seen_, done_);
    if (done_ == given_back_at_ || (++calls_ < most_calls && !quiet)) return;
    calls_ = 0;
    given_back_at_ = done_;
    ++round_;
    blocks.swap(blocks_);
  }
  release_spare_blocks();
  mallopt(M_TRIM_THRESHOLD, 0);
  blocks.clear();
  malloc_trim(0);
  mallopt(M_TRIM_THRESHOLD, kept_at_end);
}

}  // namespace papilio::server
