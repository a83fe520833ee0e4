#pragma once

#include <cstdint>
#include <vector>

#include "papilio/trigonometry.h"

// Trigonometry of + - x / and roots alone, which every machine rounds alike: the standard library's differs between
// processors and between libraries. Errors are below 0.55 units in the last place, of arc_cosine() below 1.

namespace papilio {

[[nodiscard]] inline double sine_of_turn(uint64_t part, uint64_t whole) {
  return sine_and_cosine_of_turn(part, whole).sine;
}
[[nodiscard]] inline double cosine_of_turn(uint64_t part, uint64_t whole) {
  return sine_and_cosine_of_turn(part, whole).cosine;
}
/// Of parts 0, 1, .. of `whole`: the first `count`. [count]
[[nodiscard]] std::vector<SineCosine> sines_and_cosines_of_turn(uint64_t count, uint64_t whole);
/// Of less than a quarter of a turn.
[[nodiscard]] double tangent_of_turn(uint64_t part, uint64_t whole);

/// Of an angle in 0..180 degrees.
[[nodiscard]] double cosine_of_degrees(double degrees);
/// Of an angle in 0..90 degrees, without 90.
[[nodiscard]] double tangent_of_degrees(double degrees);

/// Of an angle in 0..pi / 4, in radians.
[[nodiscard]] double cosine_of_small_angle(double radians);

/// The angle in 0..pi / 2, in radians, whose cosine in 0..1 this is.
[[nodiscard]] double arc_cosine(double cosine);

}  // namespace papilio
