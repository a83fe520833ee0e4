#include "detail/mixed_bit.h"

#include <algorithm>
#include <cmath>

namespace papilio {
namespace {

constexpr int32_t stretch_limit = 3071;  // 12 in units of 1/256
constexpr uint32_t stretch_shift = 4;    // probabilities are looked up by their upper 12 bits
constexpr uint32_t most_seen = 255;

/// Returns e^x by multiplications alone, bit-identical on every processor.
double exponential(double x) {
  double term = 1, sum = 1;
  const double small = x / 64;
  for (int i = 1; i < 12; ++i) sum += term *= small / i;
  for (int i = 0; i < 6; ++i) sum *= sum;
  return sum;
}

struct Tables {
  std::array<uint16_t, 2 * stretch_limit + 1> squash{};
  std::array<int16_t, 1U << (16 - stretch_shift)> stretch{};
  std::array<uint32_t, most_seen + 1> rate{};

  Tables() {
    for (size_t i = 0; i < squash.size(); ++i) {
      const double x = static_cast<double>(i) - stretch_limit;
      const double share = 65536 / (1 + exponential(-x / 256));
      squash[i] = static_cast<uint16_t>(std::clamp(std::lround(share), 1L, 65535L));
    }
    size_t at = 0;
    for (size_t p = 0; p < stretch.size(); ++p) {
      const size_t middle = (p << stretch_shift) + (size_t{1} << (stretch_shift - 1));
      while (at + 1 < squash.size() && squash[at + 1] <= middle) ++at;
      stretch[p] = static_cast<int16_t>(static_cast<int32_t>(at) - stretch_limit);
    }
    for (uint32_t n = 0; n <= most_seen; ++n) rate[n] = (2U << 16) / (2 * n + 3);
  }
};
const Tables tables;

}  // namespace

int32_t stretch(uint32_t probability) { return tables.stretch[probability >> stretch_shift]; }

uint32_t squash(int32_t stretched) {
  const int32_t index = std::clamp(stretched, -stretch_limit, stretch_limit) + stretch_limit;
  return tables.squash[static_cast<size_t>(index)];
}

void BitModel::update(bool bit) {
  const int64_t error = (bit ? 65535 : 0) - int32_t{probability_};
  const auto moved = static_cast<int32_t>(probability_ + ((error * tables.rate[seen_]) >> 16));
  probability_ = static_cast<uint16_t>(std::clamp(moved, 16, 65535 - 16));
  if (seen_ < most_seen) ++seen_;
}

}  // namespace papilio
