#include "server/heap.h"

#include <malloc.h>

#include <algorithm>

namespace papilio::server {

void share_arenas(int slots) { mallopt(M_ARENA_MAX, std::max(2, slots)); }

void FreeMemory::give_back() {
  const uint64_t done = done_;
  if (done == given_back_at_) return;
  given_back_at_ = done;
  malloc_trim(0);
}

}  // namespace papilio::server
