#include "base/mutex.h"
#include "papilio/buffer.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <array>
#include <bit>

namespace papilio {
namespace {

// Under the address sanitizer no block is kept, so that it detects reads of returned blocks.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool keeps = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool keeps = false;
#else
constexpr bool keeps = true;
#endif
#else
constexpr bool keeps = true;
#endif

constexpr size_t alignment = 64;
constexpr size_t huge_page = size_t{1} << 21;

// Sizes are rounded up to classes, four per doubling, so that blocks returned by one level fit the next request.
constexpr unsigned steps = 4;
constexpr size_t least = 256;

/// Class of a size, and the largest size in the class.
struct SizeClass {
  unsigned index;
  size_t bytes;
};

SizeClass class_of(size_t bytes) {
  if (bytes <= least) return {0, least};
  const auto doubling = static_cast<unsigned>(std::bit_width(bytes - 1)) - 1;  // 2^doubling < bytes <= 2^(doubling + 1)
  const size_t step = (size_t{1} << doubling) / steps;
  const size_t count = (bytes - (size_t{1} << doubling) + step - 1) / step;  // 1 to 4
  const unsigned first = static_cast<unsigned>(std::bit_width(least)) - 1;
  return {(doubling - first) * steps + static_cast<unsigned>(count), (size_t{1} << doubling) + count * step};
}

#if defined(__linux__)
// Large blocks are mapped outside the heap: madvise() applies to addresses, and would outlast the block there. Small
// allocations at those addresses would then fill pages of 2 MiB.
constexpr bool maps_large_blocks = keeps;

void* map_block(size_t bytes) {
  void* mapped = mmap(nullptr, bytes + huge_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  auto* const all = static_cast<std::byte*>(mapped);
  const size_t before = (huge_page - std::bit_cast<uintptr_t>(all) % huge_page) % huge_page;
  if (before > 0) (void)munmap(all, before);
  (void)munmap(all + before + bytes, huge_page - before);
  (void)madvise(all + before, bytes, MADV_HUGEPAGE);  // without huge pages, small ones suffice
  return all + before;
}

void unmap_block(void* block, size_t bytes) noexcept { (void)munmap(block, bytes); }
#else
constexpr bool maps_large_blocks = false;
void* map_block(size_t) { throw std::bad_alloc(); }
void unmap_block(void*, size_t) noexcept {}
#endif

void* new_block(size_t bytes) {
  if (maps_large_blocks && bytes >= huge_page) return map_block(bytes);
  return ::operator new(bytes, std::align_val_t(alignment));
}

void delete_block(void* block, size_t bytes) noexcept {
  if (maps_large_blocks && bytes >= huge_page)
    unmap_block(block, bytes);
  else
    ::operator delete(block, std::align_val_t(alignment));
}

/// Spare blocks, in one linked list per class.
class Spares {
 public:
  [[nodiscard]] void* take(SizeClass size) noexcept {
    const Lock lock(mutex_);
    Link* block = first_[size.index];
    if (block == nullptr) return nullptr;
    first_[size.index] = block->next;
    bytes_ -= size.bytes;
    return block;
  }
  /// Keeps a block; returns false, and keeps nothing, beyond `spare_limit`.
  [[nodiscard]] bool keep(void* block, SizeClass size) noexcept {
    const Lock lock(mutex_);
    if (bytes_ + size.bytes > spare_limit) return false;
    first_[size.index] = new (block) Link{first_[size.index], size.bytes};
    bytes_ += size.bytes;
    return true;
  }
  /// Releases blocks until at most `most_kept` bytes are kept: large blocks first, as they are few, and last the
  /// smallest block that suffices.
  void release(size_t most_kept) noexcept {
    Link* released = nullptr;
    {
      const Lock lock(mutex_);
      for (size_t c = classes; c-- > 0;)
        while (first_[c] != nullptr && bytes_ > most_kept && bytes_ - first_[c]->bytes >= most_kept)
          move_first(c, released);
      for (size_t c = 0; c < classes && bytes_ > most_kept; ++c)
        if (first_[c] != nullptr) move_first(c, released);
    }
    while (released != nullptr) {
      Link* next = released->next;
      delete_block(released, released->bytes);
      released = next;
    }
  }
  [[nodiscard]] size_t bytes() noexcept {
    const Lock lock(mutex_);
    return bytes_;
  }

 private:
  struct Link {
    Link* next;
    size_t bytes;
  };
  static constexpr size_t classes = size_t{64} * steps;

  /// Moves the first block of a class to another list.
  void move_first(size_t index, Link*& list) noexcept {
    Link* block = first_[index];
    first_[index] = block->next;
    bytes_ -= block->bytes;
    block->next = list;
    list = block;
  }

  Mutex mutex_;
  std::array<Link*, classes> first_{};
  size_t bytes_ = 0;
};

Spares& spares() {
  static Spares& all = *new Spares;  // never destroyed: arrays may outlive any static
  return all;
}

}  // namespace

void* take_block(size_t bytes) {
  const SizeClass size = class_of(bytes);
  if (void* block = keeps ? spares().take(size) : nullptr) return block;
  try {
    return new_block(size.bytes);
  } catch (const std::bad_alloc&) {
    if (spares().bytes() == 0) throw;
    release_spare_blocks();
    return new_block(size.bytes);
  }
}

void give_block(void* block, size_t bytes) noexcept {
  const SizeClass size = class_of(bytes);
  if (!keeps || !spares().keep(block, size)) delete_block(block, size.bytes);
}

size_t spare_bytes() noexcept { return spares().bytes(); }

void release_spare_blocks(size_t most_kept) noexcept { spares().release(most_kept); }

}  // namespace papilio
