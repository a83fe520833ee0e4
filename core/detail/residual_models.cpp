#include "detail/residual_models.h"

namespace papilio {

void ResidualModels::set_context(const ResidualContext& c) {
  level_ = level_of(c);
  uint32_t sum = 0;
  int32_t balance = 0;
  uint32_t magnitudes = 0;  // neighbours' magnitudes, up to 3, as a number of four digits
  uint32_t signs = 0;       // neighbours' signs, as a number of four digits
  for (const int32_t n : c.neighbours) {
    const auto magnitude = static_cast<uint32_t>(std::abs(n));
    sum += magnitude;
    balance += n;
    magnitudes = 4 * magnitudes + std::min(magnitude, 3U);
    signs = 3 * signs + (n > 0 ? 1U : n < 0 ? 2U : 0U);
  }
  const uint32_t near = class_of(c.known == 0 ? 0 : 8 * sum / c.known, 7);
  const uint32_t parents = class_of(c.parents, 9);
  const uint32_t turn = class_of(c.turn, 11);
  const uint32_t inner = c.is_inner ? 1 : 0;
  at_ = {(level_ * 8 + near) * 10 + parents,
         magnitudes + 256 * c.known,
         (level_ * 12 + turn) * 4 + std::min((near + 1) / 2, 3U),
         (parents * 12 + turn) * 2 + inner,
         (level_ * 2 + inner) * 8 + near,
         level_ * 5 + c.known};
  const auto lean = static_cast<uint32_t>(std::clamp(balance, -2, 2) + 2);
  sign_at_ = {lean * most_levels + level_, signs, level_};
}

}  // namespace papilio
