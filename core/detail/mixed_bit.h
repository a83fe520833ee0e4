#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

// Probabilities of bits by logistic mixing of adaptive models, in integers [Mahoney, "Adaptive Weighing of Context
// Models for Lossless Data Compression", 2005].

namespace papilio {

/// Functions of probabilities, as tables.
struct BitTables {
  static constexpr int32_t stretch_limit = 3071;  ///< 12 in units of 1/256
  static constexpr uint32_t stretch_shift = 4;    ///< probabilities are looked up by their upper 12 bits
  static constexpr uint32_t most_seen = 255;

  BitTables();

  std::array<uint16_t, 2 * stretch_limit + 1> squash{};
  std::array<int16_t, 1U << (16 - stretch_shift)> stretch{};
  std::array<uint32_t, most_seen + 1> rate{};  ///< of adaptation, in 65536ths, by the number of bits seen
};
extern const BitTables bit_tables;

/// Returns ln(p / (1 - p)) in units of 1/256, for a 16-bit probability p.
[[nodiscard]] inline int32_t stretch(uint32_t probability) {
  return bit_tables.stretch[probability >> BitTables::stretch_shift];
}
/// Returns the inverse of stretch(), clamped to 1..65535.
[[nodiscard]] inline uint32_t squash(int32_t stretched) {
  constexpr int32_t limit = BitTables::stretch_limit;
  const int32_t index = std::clamp(stretched, -limit, limit) + limit;
  return bit_tables.squash[static_cast<size_t>(index)];
}

/// Adaptive probability that a bit is one.
class BitModel {
 public:
  [[nodiscard]] uint32_t probability() const { return probability_; }
  void update(bool bit) {
    const int64_t error = (bit ? 65535 : 0) - int32_t{probability_};
    const auto moved = static_cast<int32_t>(probability_ + ((error * bit_tables.rate[seen_]) >> 16));
    probability_ = static_cast<uint16_t>(std::clamp(moved, 16, 65535 - 16));
    if (seen_ < BitTables::most_seen) ++seen_;
  }

 private:
  uint16_t probability_ = 1U << 15;
  uint16_t seen_ = 0;
};

/// Mixer of the predictions of `inputs` models, with several sets of weights that adapt to the coded bits.
template <size_t inputs>
class BitMixer {
 public:
  explicit BitMixer(size_t sets) : weights_(sets) {
    for (auto& set : weights_) set.fill(static_cast<int32_t>((1 << 16) * 12 / (10 * inputs)));
  }

  /// Returns the probability that the next bit is one. update() must follow.
  [[nodiscard]] uint32_t mix(const std::array<BitModel*, inputs>& models, size_t set) {
    models_ = models;
    set_ = set;
    int64_t sum = 0;
    for (size_t i = 0; i < inputs; ++i) {
      stretched_[i] = stretch(models[i]->probability());
      sum += int64_t{stretched_[i]} * weights_[set][i];
    }
    mixed_ = squash(static_cast<int32_t>(sum >> 16));
    return mixed_;
  }

  void update(bool bit) {
    const int32_t error = (bit ? 65535 : 0) - static_cast<int32_t>(mixed_);
    for (size_t i = 0; i < inputs; ++i) {
      int32_t& weight = weights_[set_][i];
      weight = std::clamp(weight + ((stretched_[i] * error + (1 << (learning_shift - 1))) >> learning_shift),
                          -largest_weight, largest_weight);
      models_[i]->update(bit);
    }
  }

 private:
  static constexpr int learning_shift = 15;
  static constexpr int32_t largest_weight = 1 << 24;

  std::vector<std::array<int32_t, inputs>> weights_;  // in units of 1/65536
  std::array<BitModel*, inputs> models_{};
  std::array<int32_t, inputs> stretched_{};
  size_t set_ = 0;
  uint32_t mixed_ = 0;
};

}  // namespace papilio
