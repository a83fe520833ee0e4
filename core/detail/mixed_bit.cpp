#include "detail/mixed_bit.h"

#include <algorithm>
#include <cmath>

namespace papilio {
namespace {

/// Returns e^x by multiplications alone, bit-identical on every processor.
double exponential(double x) {
  double term = 1, sum = 1;
  const double small = x / 64;
  for (int i = 1; i < 12; ++i) sum += term *= small / i;
  for (int i = 0; i < 6; ++i) sum *= sum;
  return sum;
}

}  // namespace

BitTables::BitTables() {
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
  for (uint32_t n = 0; n <= most_seen; ++n) rate[n] = (1U << 16) / (n + 2);
}

const BitTables bit_tables;

}  // namespace papilio
