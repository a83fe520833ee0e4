#include "split/split_pattern.h"

#include <bit>

namespace papilio {
namespace {

using Corners = std::array<uint8_t, 3>;

constexpr uint8_t turn(uint8_t local, unsigned by) {
  return local < 3 ? static_cast<uint8_t>((local + by) % 3) : static_cast<uint8_t>((local - 3U + by) % 3 + 3);
}

constexpr void add(SplitPattern& pattern, unsigned by, Corners corners) {
  for (uint8_t& c : corners) c = turn(c, by);
  pattern.corner[pattern.children++] = corners;
}

constexpr bool is_outer(uint8_t from, uint8_t to, unsigned i) {
  const auto first = static_cast<uint8_t>(i);
  const auto last = static_cast<uint8_t>((i + 1) % 3);
  const auto middle = static_cast<uint8_t>(3 + i);
  return (from == first && (to == last || to == middle)) || (from == middle && to == last);
}

/// Derives every table from the children's corners.
constexpr void connect(SplitPattern& pattern) {
  const unsigned count = 3U * pattern.children;
  const auto from = [&](unsigned h) { return pattern.corner[h / 3][h % 3]; };
  const auto tip = [&](unsigned h) { return pattern.corner[h / 3][(h % 3 + 1) % 3]; };
  uint8_t inner_edges = 0;
  for (unsigned h = 0; h < count; ++h) {
    pattern.inner_twin[h] = SplitPattern::outside;
    for (unsigned other = 0; other < count; ++other) {
      if (from(other) != tip(h) || tip(other) != from(h)) continue;
      pattern.inner_twin[h] = static_cast<uint8_t>(other);
      pattern.edge[h] = other < h ? pattern.edge[other] : inner_edges++;
    }
    for (unsigned i = 0; i < 3; ++i) {
      if (!is_outer(from(h), tip(h), i)) continue;
      const auto half = static_cast<uint8_t>(2 * i + (from(h) == i ? 0 : 1));
      pattern.edge[h] = half;
      pattern.outer[half] = static_cast<uint8_t>(h);
    }
  }
}

constexpr SplitPattern make(unsigned mask, bool second_diagonal) {
  SplitPattern pattern;
  switch (std::popcount(mask)) {
    case 0:
      add(pattern, 0, {0, 1, 2});
      break;
    case 1: {
      const unsigned i = first_target[mask];
      add(pattern, i, {0, 3, 2});
      add(pattern, i, {3, 1, 2});
      break;
    }
    case 2: {
      const unsigned i = first_target[mask];
      add(pattern, i, {3, 1, 4});
      if (second_diagonal) {
        add(pattern, i, {0, 3, 2});
        add(pattern, i, {3, 4, 2});
      } else {
        add(pattern, i, {0, 3, 4});
        add(pattern, i, {0, 4, 2});
      }
      break;
    }
    default:  // each outer child keeps its corner at the parent's place; the middle one comes last
      add(pattern, 0, {0, 3, 5});
      add(pattern, 0, {3, 1, 4});
      add(pattern, 0, {5, 4, 2});
      add(pattern, 0, {3, 4, 5});
  }
  connect(pattern);
  return pattern;
}

constexpr std::array<SplitPattern, 16> make_all() {
  std::array<SplitPattern, 16> all{};
  for (unsigned mask = 0; mask < 8; ++mask)
    for (unsigned second = 0; second < 2; ++second) all[2 * mask + second] = make(mask, second != 0);
  return all;
}

}  // namespace

constinit const std::array<SplitPattern, 16> split_patterns = make_all();

}  // namespace papilio
