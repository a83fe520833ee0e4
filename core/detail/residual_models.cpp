#include "detail/residual_models.h"

#include <cmath>

namespace papilio {

void ResidualModels::set_context(const ResidualContext& c) {
  const double expected = expected_.at(c);
  is_turned_ = expected < 0;
  const double size = std::abs(expected);
  shift_ = std::max(0, static_cast<int32_t>(size) - 1);
  shift_class_ = std::min(static_cast<uint32_t>(shift_), shift_classes - 1);
  expectation_ = shift_ > 0 ? expectations - 1 : std::min(static_cast<uint32_t>(4 * size), expectations - 2);
  level_ = level_of(c);
  uint32_t sum = 0;
  uint32_t magnitudes = 0;  // neighbours' magnitudes, up to 3, as a number of four digits
  signs_ = 0;               // neighbours' signs, as a number of four digits
  for (const int32_t n : c.neighbours) {
    const auto magnitude = static_cast<uint32_t>(std::abs(n));
    sum += magnitude;
    magnitudes = 4 * magnitudes + std::min(magnitude, 3U);
    signs_ = 3 * signs_ + (n == 0 ? 0U : (n > 0) != is_turned_ ? 1U : 2U);
  }
  const uint32_t near = class_of(c.known == 0 ? 0 : 8 * sum / c.known, 7);
  const uint32_t turn = class_of(c.turn, 11);
  const auto size_of = [](int32_t value) { return static_cast<uint32_t>(std::abs(value)); };
  const uint32_t around = 16 * sum + 8 * size_of(c.sibling) + 4 * size_of(c.beyond) + c.parents + c.turn / 2;
  const uint32_t count = 2 * c.known + 1 + (c.has_sibling ? 1 : 0) + (c.has_beyond ? 1 : 0);
  spread_ = spread_of(around / count);
  at_ = {magnitudes + 256 * c.known, (level_ * 12 + turn) * 4 + std::min((near + 1) / 2, 3U),
         expectation_ * spreads + spread_, (shift_class_ * expectations + expectation_) * most_levels + level_};
}

}  // namespace papilio
