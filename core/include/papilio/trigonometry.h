#pragma once

#include <cstdint>

namespace papilio {

struct SineCosine {
  double sine, cosine;
};

/// Returns sine and cosine of `part` / `whole` full turns, bit-identical on every processor. `whole` is in 1..2^48.
[[nodiscard]] SineCosine sine_and_cosine_of_turn(uint64_t part, uint64_t whole);

}  // namespace papilio
