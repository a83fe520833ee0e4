#include "detail/expected_residual.h"

#include <algorithm>
#include <numeric>

namespace papilio {
namespace {

constexpr double largest_bow = 200;     ///< in steps
constexpr double first_squares = 3000;  ///< of an input, as if seen before: how slowly weights adapt at first

}  // namespace

// The weights that real models end with, in the mean.
ExpectedResidual::ExpectedResidual() {
  for (size_t level = 0; level < levels; ++level)
    for (uint32_t known = 0; known <= most_neighbours; ++known) {
      const bool is_outer = known < 2;  // mostly
      const double bow = level == 0 ? -0.45 : level == 1 && is_outer ? -0.35 : 0;
      Weights& set = weights_[level * (most_neighbours + 1) + known];
      set.weight = {0.3, is_outer ? 0.13 : 0, is_outer ? -0.25 : 0, -0.08, bow};
      set.sum_of_squares.fill(first_squares);
    }
}

double ExpectedResidual::at(const ResidualContext& c) {
  const size_t level = std::clamp<size_t>(c.level, 1, levels) - 1;
  set_ = level * (most_neighbours + 1) + c.known;
  const int32_t neighbours = std::accumulate(c.neighbours.begin(), c.neighbours.end(), 0);
  input_ = {static_cast<double>(neighbours), static_cast<double>(c.ends), static_cast<double>(c.sibling),
            static_cast<double>(c.beyond), std::clamp(c.bow, -largest_bow, largest_bow)};
  expected_ = 0;
  for (size_t i = 0; i < inputs; ++i) expected_ += weights_[set_].weight[i] * input_[i];
  constexpr auto most = static_cast<double>(largest_residual);
  return expected_ = std::clamp(expected_, -most, most);
}

void ExpectedResidual::update(int32_t residual) {
  Weights& set = weights_[set_];
  const double error = residual - expected_;
  for (size_t i = 0; i < inputs; ++i) {
    set.sum_of_squares[i] += input_[i] * input_[i];
    set.weight[i] += error * input_[i] / set.sum_of_squares[i];
  }
}

}  // namespace papilio
