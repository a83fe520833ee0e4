#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>
#include <vector>

// Memory for what a mesh is made of: arrays that are long, written once from end to end, and made again at every level
// of every request. The system gives fresh pages slowly, so what is given back is kept for the next to ask.

namespace papilio {

/// A block of at least so many bytes, aligned to 64. May be called from any thread. Throws std::bad_alloc.
[[nodiscard]] void* take_block(size_t bytes);
/// Gives it back, with the number it was asked for.
void give_block(void* block, size_t bytes) noexcept;

/// Bytes kept for later; never more than `spare_limit`.
[[nodiscard]] size_t spare_bytes() noexcept;
inline constexpr size_t spare_limit = size_t{2} << 30;
/// Gives back to the system what is kept.
void release_spare_blocks() noexcept;

/// Takes blocks; new elements are filled as the standard library's vectors fill them.
template <class T>
struct ListAllocator {
  using value_type = T;
  /// Bytes that may be read behind the last element: lanes.h.
  static constexpr size_t behind_end = 16;

  ListAllocator() = default;
  template <class Other>
  ListAllocator(const ListAllocator<Other>& /*other*/) {}  // NOLINT(google-explicit-constructor): as allocators are

  [[nodiscard]] T* allocate(size_t count) {
    if (count > (SIZE_MAX - behind_end) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(take_block(count * sizeof(T) + behind_end));
  }
  void deallocate(T* block, size_t count) noexcept { give_block(block, count * sizeof(T) + behind_end); }

  friend bool operator==(const ListAllocator&, const ListAllocator&) { return true; }
};

/// The same, but leaves new elements as they are where no value is given for them.
template <class T>
struct ArrayAllocator : ListAllocator<T> {
  ArrayAllocator() = default;
  template <class Other>
  ArrayAllocator(const ArrayAllocator<Other>& /*other*/) {}  // NOLINT(google-explicit-constructor): as allocators are

  template <class Element>
  void construct(Element* /*at*/) noexcept {}
  template <class Element, class... Values>
  void construct(Element* at, Values&&... values) {
    ::new (static_cast<void*>(at)) Element(std::forward<Values>(values)...);
  }
};

/// A vector of plain numbers.
template <class T>
using List = std::vector<T, ListAllocator<T>>;

/// One whose `Array(n)` and `resize(n)` do not fill: what they add must be written before it is read.
template <class T>
using Array = std::vector<T, ArrayAllocator<T>>;

}  // namespace papilio
