#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <utility>

namespace papilio {

/// Moves the element at `at` down to its place in a heap in which all others are in order.
template <class T, class Less>
void sift_down(T* heap, size_t count, size_t at, const Less& less) {
  T moved = std::move(heap[at]);
  for (size_t child = 2 * at + 1; child < count; child = 2 * at + 1) {
    if (child + 1 < count && less(heap[child], heap[child + 1])) ++child;
    if (!less(moved, heap[child])) break;
    heap[at] = std::move(heap[child]);
    at = child;
  }
  heap[at] = std::move(moved);
}

template <class T, class Less>
void heap_sort(T* first, size_t count, const Less& less) {
  for (size_t i = count / 2; i-- > 0;) sift_down(first, count, i, less);
  for (size_t left = count; left-- > 1;) {
    std::swap(first[0], first[left]);
    sift_down(first, left, 0, less);
  }
}

template <class T, class Less>
void insertion_sort(T* first, T* last, const Less& less) {
  if (first == last) return;
  for (T* next = first + 1; next != last; ++next) {
    T moved = std::move(*next);
    T* at = next;
    for (; at != first && less(moved, at[-1]); --at) *at = std::move(at[-1]);
    *at = std::move(moved);
  }
}

/// Partitions at least three elements around their median of three. Returns the begin of the second part: no element of
/// the first is greater than any of the second, and neither is empty.
template <class T, class Less>
T* split_range(T* first, T* last, const Less& less) {
  T* const middle = first + (last - first) / 2;
  if (less(*middle, *first)) std::swap(*middle, *first);
  if (less(last[-1], *middle)) {
    std::swap(last[-1], *middle);
    if (less(*middle, *first)) std::swap(*middle, *first);
  }
  const T pivot = *middle;
  T* up = first;
  T* down = last - 1;
  while (true) {
    do ++up;
    while (less(*up, pivot));
    do --down;
    while (less(pivot, *down));
    if (up >= down) return up;
    std::swap(*up, *down);
  }
}

/// Sorts a range by quicksort; by heapsort after `splits` partitions. O(n log n). The order of equal elements is
/// unspecified.
template <class T, class Less>
void small_sort(T* first, T* last, const Less& less, int splits) {
  constexpr ptrdiff_t short_range = 16;
  while (last - first > short_range) {
    if (splits-- == 0) {
      heap_sort(first, static_cast<size_t>(last - first), less);
      return;
    }
    T* const second = split_range(first, last, less);
    small_sort(second, last, less, splits);
    last = second;
  }
  insertion_sort(first, last, less);
}

/// Sorts a range in which equal elements are indistinguishable. In a WebAssembly module the standard library's sort,
/// compiled for each type, would take an eighth of all bytes; small_sort() replaces it there.
template <class Range, class Less = std::ranges::less>
void sort_range(Range&& range, const Less& less = {}) {
#if defined(__wasm__)
  auto* const first = std::to_address(std::begin(range));
  const auto count = static_cast<size_t>(std::end(range) - std::begin(range));
  small_sort(first, first + count, less, 2 * static_cast<int>(std::bit_width(count)));
#else
  std::ranges::sort(range, less);
#endif
}

}  // namespace papilio
