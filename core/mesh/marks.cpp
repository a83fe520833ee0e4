#include "mesh/marks.h"

#include "base/ids.h"

#include <numeric>

namespace papilio {

Marks used_by_faces(const Buffer<uint32_t>& faces, const Buffer<uint32_t>& of, uint32_t count) {
  Marks used(count, 0);
  uint8_t* marks = used.data();  // hoisted: stores to bytes may alias the buffer's pointer
  const uint32_t* of_half_edge = of.data();
  for (FaceId f : faces)
    for (uint32_t i = 0; i < 3; ++i) marks[of_half_edge[3 * f + i]] = 1;
  return used;
}

// Branch-free: the marks are unpredictable.
Buffer<uint32_t> marked(const Marks& marks) {
  // One element more than the largest result: unmarked numbers are written too, and then overwritten.
  auto numbers = Buffer<uint32_t>::for_overwrite(marks.size() + 1);
  size_t count = 0;
  for (size_t i = 0; i < marks.size(); ++i) {
    numbers[count] = static_cast<uint32_t>(i);
    count += marks[i];
  }
  numbers.resize(count);
  return numbers;
}

}  // namespace papilio
