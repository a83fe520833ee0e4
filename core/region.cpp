#include "region.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <numeric>

namespace papilio {

Region whole_region(const Topology& mesh) {
  Region region{List<uint32_t>(mesh.face_count()), EdgeMarks(mesh.edge_count(), 1)};
  std::iota(region.faces.begin(), region.faces.end(), 0U);
  return region;
}

List<uint32_t> Region::edges() const { return marked(has_edge); }

namespace {

using Word = uint64_t;
constexpr size_t words_a_block = 8;
constexpr size_t block = words_a_block * sizeof(Word);

/// Block by block, as bytes hold what is in one, and many bytes are added at once.
size_t count_marked(const List<uint8_t>& marks) {
  size_t count = 0;
  for (size_t first = 0; first < marks.size(); first += block) {
    uint8_t in_block = 0;
    if (first + block <= marks.size())
      for (size_t i = 0; i < block; ++i) in_block += marks[first + i] != 0 ? 1 : 0;
    else
      for (size_t i = first; i < marks.size(); ++i) in_block += marks[i] != 0 ? 1 : 0;
    count += in_block;
  }
  return count;
}

}  // namespace

List<uint32_t> marked(const List<uint8_t>& marks) {
  const size_t count = count_marked(marks);
  List<uint32_t> numbers(count + 1);  // one more than needed: what is not marked is written, and then replaced
  size_t known = 0;
  const auto look_at = [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      numbers[known] = static_cast<uint32_t>(i);
      known += marks[i] != 0 ? 1 : 0;
    }
  };
  // One in so many: then most words have none. Else nobody can guess which have.
  constexpr size_t few = 16;
  size_t first = 0;
  for (; few * count < marks.size() && first + block <= marks.size() && known < count; first += block) {
    std::array<Word, words_a_block> words;
    std::memcpy(words.data(), &marks[first], block);
    if (std::accumulate(words.begin(), words.end(), Word{0}, std::bit_or<>()) == 0) continue;
    for (size_t w = 0; w < words_a_block; ++w)
      if (words[w] != 0) look_at(first + w * sizeof(Word), first + (w + 1) * sizeof(Word));
  }
  if (known < count) look_at(first, marks.size());
  numbers.pop_back();
  return numbers;
}

}  // namespace papilio
