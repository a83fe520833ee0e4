#include "mesh/region.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace papilio {

Region whole_region(const Topology& mesh) {
  Region region{Buffer<uint32_t>(mesh.face_count()), EdgeMarks(mesh.edge_count(), 1)};
  std::iota(region.faces.begin(), region.faces.end(), 0U);
  return region;
}

Buffer<uint32_t> Region::edges() const { return marked(has_edge); }

Buffer<uint8_t> used_by_faces(const Buffer<uint32_t>& faces, const Buffer<uint32_t>& of, uint32_t count) {
  Buffer<uint8_t> used(count, 0);
  uint8_t* marks = used.data();  // not read again at each mark
  const uint32_t* of_half_edge = of.data();
  for (uint32_t f : faces)
    for (uint32_t i = 0; i < 3; ++i) marks[of_half_edge[3 * f + i]] = 1;
  return used;
}

Buffer<uint32_t> shared_half_edges(const Topology& mesh) {
  Buffer<uint32_t> shared;
  if (std::ranges::find(mesh.kind, EdgeKind::shared) == mesh.kind.end()) return shared;
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
    if (mesh.kind[mesh.edge[h]] == EdgeKind::shared) shared.push_back(h);
  return shared;
}

// Without a branch at each mark, for nobody can guess which are set; where most are not, words of none are passed over.
Buffer<uint32_t> marked(const Buffer<uint8_t>& marks) {
  using Word = uint64_t;
  // One more than there are at most: what is not marked is written, and then replaced.
  auto numbers = Buffer<uint32_t>::for_overwrite(marks.size() + 1);
  const uint8_t* const is_marked = marks.data();
  uint32_t* const all = numbers.data();
  size_t count = 0;
  const auto look_at = [=, &count](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      all[count] = static_cast<uint32_t>(i);
      count += is_marked[i];
    }
  };
  size_t first = 0;
  for (; first + sizeof(Word) <= marks.size(); first += sizeof(Word)) {
    Word word;
    std::memcpy(&word, is_marked + first, sizeof(word));
    if (word != 0) look_at(first, first + sizeof(Word));
  }
  look_at(first, marks.size());
  numbers.resize(count);
  return numbers;
}

}  // namespace papilio
