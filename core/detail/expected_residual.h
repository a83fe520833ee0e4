#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "detail/residual_context.h"

namespace papilio {

/// Expected residual, from residuals near it that are coded already and the bow of the prediction, whose weights adapt
/// [normalized least mean squares: Nagumo & Noda, "A Learning Method for System Identification", 1967]. Residuals near
/// each other have mostly one sign, and on coarse levels the prediction is too round. Bit-identical on every processor.
class ExpectedResidual {
 public:
  ExpectedResidual();

  /// Returns the expectation, in steps, of at most `largest_residual` either way. update() must follow.
  [[nodiscard]] double at(const ResidualContext& context);
  /// Adapts the weights to the residual that was coded.
  void update(int32_t residual);

 private:
  static constexpr size_t inputs = 5, levels = 4, sets = levels * (most_neighbours + 1);
  struct Weights {
    std::array<double, inputs> weight{}, sum_of_squares{};
  };
  std::array<Weights, sets> weights_{};  // by level and number of known neighbours
  size_t set_ = 0;
  std::array<double, inputs> input_{};
  double expected_ = 0;
};

}  // namespace papilio
