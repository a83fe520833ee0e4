#include "region.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace papilio {

Region whole_region(const Topology& mesh) {
  Region region{List<uint32_t>(mesh.face_count()), List<uint32_t>(mesh.edge_count())};
  std::iota(region.faces.begin(), region.faces.end(), 0U);
  std::iota(region.edges.begin(), region.edges.end(), 0U);
  return region;
}

List<uint32_t> marked(const List<uint8_t>& marks) {
  const auto count = marks.size() - static_cast<size_t>(std::ranges::count(marks, 0));
  List<uint32_t> numbers(count + 1);  // one more than needed: what is not marked is written, and then replaced
  size_t known = 0;
  for (size_t i = 0; i < marks.size();) {
    uint64_t eight = 1;
    if (i % 8 == 0 && i + 8 <= marks.size()) std::memcpy(&eight, &marks[i], 8);
    if (eight == 0) {
      i += 8;
      continue;
    }
    numbers[known] = static_cast<uint32_t>(i);
    known += marks[i] != 0 ? 1 : 0;
    ++i;
  }
  numbers.pop_back();
  return numbers;
}

}  // namespace papilio
