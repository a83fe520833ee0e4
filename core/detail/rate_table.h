#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace papilio {

/// Estimate of the bits of one level's residuals, from the frequency of each magnitude in similar neighbourhoods.
class RateTable {
 public:
  /// Counts a residual; `around` is the sum of its neighbours' magnitudes.
  void count(uint32_t around, int32_t residual) { ++table_[kind(around)][row(residual)]; }
  /// Converts counts into bits.
  void finish() {
    for (auto& counts : table_) {
      float total = 0;
      for (float& c : counts) total += c += 0.5F;
      for (uint32_t m = 0; m < magnitudes; ++m) counts[m] = std::log2(total / counts[m]) + (m > 0 ? 1.0F : 0.0F);
    }
  }
  [[nodiscard]] float bits(uint32_t around, int32_t residual) const {
    const float beyond = static_cast<float>(std::abs(residual)) - static_cast<float>(row(residual));
    return table_[kind(around)][row(residual)] + bits_beyond * beyond;
  }

 private:
  static constexpr uint32_t kinds = 5, magnitudes = 16;
  static constexpr float bits_beyond = 0.3F;  ///< bits of each unit above the last magnitude

  static uint32_t kind(uint32_t around) { return around < 3 ? around : around < 6 ? 3 : 4; }
  static uint32_t row(int32_t residual) { return std::min(static_cast<uint32_t>(std::abs(residual)), magnitudes - 1); }

  std::array<std::array<float, magnitudes>, kinds> table_{};
};

}  // namespace papilio
