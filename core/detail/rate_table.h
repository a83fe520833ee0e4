#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace papilio {

/// Estimate of the bits that residuals of one level take, from how often each magnitude occurs among like ones.
class RateTable {
 public:
  /// Counts a residual, whose neighbours' magnitudes have the sum `around`.
  void count(uint32_t around, int32_t residual) { ++table_[kind(around)][row(residual)]; }
  /// Turns counts into bits.
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
  static constexpr float bits_beyond = 0.3F;  ///< of each unit above the last magnitude

  static uint32_t kind(uint32_t around) { return around < 3 ? around : around < 6 ? 3 : 4; }
  static uint32_t row(int32_t residual) { return std::min(static_cast<uint32_t>(std::abs(residual)), magnitudes - 1); }

  std::array<std::array<float, magnitudes>, kinds> table_{};
};

}  // namespace papilio
