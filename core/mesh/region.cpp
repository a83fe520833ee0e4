#include "mesh/region.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <functional>
#include <numeric>

namespace papilio {

Region whole_region(const Topology& mesh) {
  Region region{Buffer<uint32_t>(mesh.face_count()), EdgeMarks(mesh.edge_count(), 1)};
  std::iota(region.faces.begin(), region.faces.end(), 0U);
  return region;
}

Buffer<uint32_t> Region::edges() const { return marked(has_edge); }

Buffer<uint32_t> shared_half_edges(const Topology& mesh) {
  Buffer<uint32_t> shared;
  if (std::ranges::find(mesh.kind, EdgeKind::shared) == mesh.kind.end()) return shared;
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
    if (mesh.kind[mesh.edge[h]] == EdgeKind::shared) shared.push_back(h);
  return shared;
}

namespace {

using Word = uint64_t;
constexpr size_t words_a_block = 8;
constexpr size_t block = words_a_block * sizeof(Word);

/// Block by block, as bytes hold what is in one, and many bytes are added at once.
size_t count_marked(const Buffer<uint8_t>& marks) {
  size_t count = 0;
  for (size_t first = 0; first < marks.size(); first += block) {
    uint8_t in_block = 0;
    if (first + block <= marks.size())
      for (size_t i = 0; i < block; ++i) in_block += marks[first + i];
    else
      for (size_t i = first; i < marks.size(); ++i) in_block += marks[i];
    count += in_block;
  }
  return count;
}

}  // namespace

namespace {

/// Of four marks: which of them are, in front, by the bits that say so.
using FourOffsets = uint32_t __attribute__((vector_size(16)));
constexpr std::array<std::array<uint32_t, 4>, 16> make_offsets() {
  std::array<std::array<uint32_t, 4>, 16> all{};
  for (uint32_t bits = 0; bits < all.size(); ++bits) {
    size_t known = 0;
    for (uint32_t i = 0; i < 4; ++i)
      if ((bits >> i & 1U) != 0) all[bits][known++] = i;
  }
  return all;
}
alignas(16) constexpr std::array<std::array<uint32_t, 4>, 16> offsets_of = make_offsets();
constexpr std::array<uint8_t, 16> count_of{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

/// Bit i is set where the i-th of four marks is.
uint32_t bits_of_four(const uint8_t* marks) {
  uint32_t word;
  std::memcpy(&word, marks, sizeof(word));
  // Each mark comes to lie in one of the highest bits.
  return std::endian::native == std::endian::little ? word * 0x10204080U >> 28U : word * 0x08040201U >> 24U & 15U;
}

}  // namespace

Buffer<uint32_t> marked(const Buffer<uint8_t>& marks) {
  const size_t count = count_marked(marks);
  Buffer<uint32_t> numbers(count + 4);  // more than needed: what is not marked is written, and then replaced
  size_t known = 0;
  const uint8_t* const is_marked = marks.data();  // not read again at each
  uint32_t* const all = numbers.data();
  const auto look_at_four = [=, &known](size_t first) {
    const uint32_t bits = bits_of_four(is_marked + first);
    FourOffsets offsets;
    std::memcpy(&offsets, offsets_of[bits].data(), sizeof(offsets));
    offsets += static_cast<uint32_t>(first);
    std::memcpy(all + known, &offsets, sizeof(offsets));
    known += count_of[bits];
  };
  // One in so many: then most words have none. Else nobody can guess which have.
  constexpr size_t few = 16;
  size_t first = 0;
  for (; few * count < marks.size() && first + block <= marks.size() && known < count; first += block) {
    std::array<Word, words_a_block> words;
    std::memcpy(words.data(), &marks[first], block);
    if (std::accumulate(words.begin(), words.end(), Word{0}, std::bit_or<>()) == 0) continue;
    for (size_t w = 0; w < words_a_block; ++w) {
      if (words[w] == 0) continue;
      look_at_four(first + w * sizeof(Word));
      look_at_four(first + w * sizeof(Word) + 4);
    }
  }
  for (; first + 4 <= marks.size() && known < count; first += 4) look_at_four(first);
  for (; first < marks.size() && known < count; ++first) {
    numbers[known] = static_cast<uint32_t>(first);
    known += marks[first];
  }
  numbers.resize(count);
  return numbers;
}

}  // namespace papilio
