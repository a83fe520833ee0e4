#pragma once

#include <cstdint>
#include <vector>

#include "papilio/trigonometry.h"

// Trigonometry by + - x / and square roots alone, so that results are bit-identical on every processor; the standard
// library's differ. Errors are below 0.55 units in the last place; below 1 for arc_cosine().

namespace papilio {

[[nodiscard]] inline double sine_of_turn(uint64_t part, uint64_t whole) {
  return sine_and_cosine_of_turn(part, whole).sine;
}
[[nodiscard]] inline double cosine_of_turn(uint64_t part, uint64_t whole) {
  return sine_and_cosine_of_turn(part, whole).cosine;
}
/// Returns [count] sine and cosine of i / `whole` turns for each i below `count`.
[[nodiscard]] std::vector<SineCosine> sines_and_cosines_of_turn(uint64_t count, uint64_t whole);
/// Returns the tangent of `part` / `whole` turns, less than a quarter of a turn.
[[nodiscard]] double tangent_of_turn(uint64_t part, uint64_t whole);

/// Returns the cosine of an angle in 0..180 degrees.
[[nodiscard]] double cosine_of_degrees(double degrees);
/// Returns the tangent of an angle in [0, 90) degrees.
[[nodiscard]] double tangent_of_degrees(double degrees);

/// Returns the cosine of an angle in 0..pi / 4 radians.
[[nodiscard]] double cosine_of_small_angle(double radians);

/// Returns the angle in 0..pi / 2 radians of a cosine in 0..1.
[[nodiscard]] double arc_cosine(double cosine);

}  // namespace papilio
