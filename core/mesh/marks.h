#pragma once

#include <cstdint>

#include "base/ids.h"
#include "papilio/mesh.h"

// Subsets of the faces, edges or vertices of a mesh: marks, or numbers in ascending order.

namespace papilio {

/// One byte for each face, edge or vertex of a mesh: 1 if it is in the subset, else 0.
using Marks = Buffer<uint8_t>;

/// Returns the numbers for which `is_kept` is true, in their order. Branch-free: the predicate is unpredictable.
template <class IsKept>
[[nodiscard]] Buffer<uint32_t> chosen(const Buffer<uint32_t>& numbers, const IsKept& is_kept) {
  auto kept = Buffer<uint32_t>::for_overwrite(numbers.size() + 1);  // the next number overwrites one that is not kept
  uint32_t* end = kept.data();
  for (uint32_t number : numbers) {
    *end = number;
    end += is_kept(number) ? 1 : 0;
  }
  kept.resize(static_cast<size_t>(end - kept.data()));
  return kept;
}
/// Keeps the numbers for which `is_kept` is true, in their order.
template <class IsKept>
void keep_if(Buffer<uint32_t>& numbers, const IsKept& is_kept) {
  numbers = chosen(numbers, is_kept);
}

/// Returns the marked numbers in ascending order. Marks are 0 or 1.
[[nodiscard]] Buffer<uint32_t> marked(const Marks& marks);

/// Returns whether a corner of the face is marked. `marks` [V]
[[nodiscard]] inline bool is_touched(const Topology& mesh, const Buffer<uint8_t>& marks, FaceId face) {
  const uint32_t* corner = &mesh.origin[size_t{3} * face];
  return (marks[corner[0]] | marks[corner[1]] | marks[corner[2]]) != 0;
}
/// Marks the corners or edges of some faces: `of` [H] is the vertex or edge of each half-edge, below `count`.
[[nodiscard]] Marks used_by_faces(const Buffer<uint32_t>& faces, const Buffer<uint32_t>& of, uint32_t count);

}  // namespace papilio
