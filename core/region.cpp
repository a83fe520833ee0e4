#include "region.h"

#include <cstring>
#include <numeric>

namespace papilio {

Region whole_region(const Topology& mesh) {
  Region region{std::vector<uint32_t>(mesh.face_count()), std::vector<uint32_t>(mesh.edge_count())};
  std::iota(region.faces.begin(), region.faces.end(), 0U);
  std::iota(region.edges.begin(), region.edges.end(), 0U);
  return region;
}

std::vector<uint32_t> marked(const std::vector<uint8_t>& marks) {
  std::vector<uint32_t> numbers;
  for (size_t i = 0; i < marks.size();) {
    uint64_t eight = 1;
    if (i % 8 == 0 && i + 8 <= marks.size()) std::memcpy(&eight, &marks[i], 8);
    if (eight == 0) {
      i += 8;
      continue;
    }
    if (marks[i] != 0) numbers.push_back(static_cast<uint32_t>(i));
    ++i;
  }
  return numbers;
}

}  // namespace papilio
