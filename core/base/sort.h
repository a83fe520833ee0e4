#pragma once

#include <algorithm>
#include <functional>

namespace papilio {

/// Sorts a range in which equal elements are indistinguishable. In a WebAssembly module the standard library's sort,
/// compiled for each type, would take an eighth of all bytes; its heapsort is small.
template <class Range, class Less = std::ranges::less>
void sort_range(Range&& range, const Less& less = {}) {
#if defined(__wasm__)
  std::ranges::make_heap(range, less);
  std::ranges::sort_heap(range, less);
#else
  std::ranges::sort(range, less);
#endif
}

}  // namespace papilio
