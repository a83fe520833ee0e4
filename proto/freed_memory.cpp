#include "proto/freed_memory.h"

#include <cstdlib>  // defines __GLIBC__

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "papilio/buffer.h"

namespace papilio::proto {

void trim_heap() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

void give_back_freed() {
  release_spare_blocks();
  trim_heap();
}

void make_room(uint64_t bytes) {
  const size_t spare = spare_bytes();
  if (bytes <= spare)
    release_spare_blocks(spare - static_cast<size_t>(bytes));
  else if (bytes >= worth_giving_back)
    give_back_freed();
}

}  // namespace papilio::proto
