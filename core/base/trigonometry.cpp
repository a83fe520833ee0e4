#include "base/trigonometry.h"

#include <array>
#include <cmath>

#include "base/doubled.h"

namespace papilio {
namespace {

constexpr Doubled quarter_of_pi{0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55};
constexpr Doubled one_degree = quarter_of_pi / Doubled{45};

/// Returns the sum of coefficient[i] x^i.
template <size_t count>
double polynomial(const std::array<double, count>& coefficients, double x) {
  double sum = 0;
  for (size_t i = count; i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

struct DoubledSineCosine {
  Doubled sine, cosine;
};

/// Returns sine and cosine of an angle in 0..pi / 4, by the power series. Its first terms are exact; only they affect
/// the last place.
DoubledSineCosine sine_and_cosine(Doubled x) {
  constexpr std::array<double, 7> of_sine{1.0 / 120,        -1.0 / 5040,          1.0 / 362880,         -1.0 / 39916800,
                                          1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
  constexpr std::array<double, 8> of_cosine{
      1.0 / 24,        -1.0 / 720,         1.0 / 40320,          -1.0 / 3628800,
      1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000, -1.0 / 6402373705728000};
  constexpr Doubled sixth = Doubled{1} / Doubled{6};
  const Doubled square = x * x;
  const double fourth_power = square.high * square.high;

  const Doubled cubic = square * x * sixth;
  const Doubled first = exact_sum(x.high, -cubic.high);
  const double rest = x.high * fourth_power * polynomial(of_sine, square.high);
  const Doubled sine = sum_to_larger(first.high, first.low + ((x.low - cubic.low) + rest));

  const Doubled start = sum_to_larger(1, -0.5 * square.high);
  const double end = fourth_power * polynomial(of_cosine, square.high);
  return {sine, sum_to_larger(start.high, start.low + (end - 0.5 * square.low))};
}

/// Returns sine and cosine of part / whole eighths of a turn, where part <= whole.
DoubledSineCosine of_eighth(uint64_t part, uint64_t whole) {
  return sine_and_cosine(Doubled{static_cast<double>(part)} / Doubled{static_cast<double>(whole)} * quarter_of_pi);
}

DoubledSineCosine of_degrees(double degrees) { return sine_and_cosine(Doubled{degrees} * one_degree); }

double quotient(Doubled a, Doubled b) { return (a / b).high; }

}  // namespace

SineCosine sine_and_cosine_of_turn(uint64_t part, uint64_t whole) {
  part %= whole;
  const bool is_in_lower_half = 2 * part > whole;
  uint64_t eighths = 8 * (is_in_lower_half ? whole - part : part);  // eighths of a turn times `whole`: 0..4 whole
  const bool is_in_left_half = eighths > 2 * whole;
  if (is_in_left_half) eighths = 4 * whole - eighths;
  const bool is_steep = eighths > whole;
  if (is_steep) eighths = 2 * whole - eighths;
  const DoubledSineCosine found = of_eighth(eighths, whole);
  const double sine = is_steep ? found.cosine.high : found.sine.high;
  const double cosine = is_steep ? found.sine.high : found.cosine.high;
  return {is_in_lower_half ? -sine : sine, is_in_left_half ? -cosine : cosine};
}

std::vector<SineCosine> sines_and_cosines_of_turn(uint64_t count, uint64_t whole) {
  std::vector<SineCosine> of_parts(count);
  for (uint64_t part = 0; part < count; ++part) of_parts[part] = sine_and_cosine_of_turn(part, whole);
  return of_parts;
}

double tangent_of_turn(uint64_t part, uint64_t whole) {
  const bool is_steep = 8 * part > whole;
  const DoubledSineCosine found = of_eighth(is_steep ? 2 * whole - 8 * part : 8 * part, whole);
  return is_steep ? quotient(found.cosine, found.sine) : quotient(found.sine, found.cosine);
}

// Differences of angles are exact (Sterbenz): the two are within a factor of two.
double cosine_of_degrees(double degrees) {
  if (degrees > 135) return -of_degrees(180 - degrees).cosine.high;
  return degrees > 45 ? (degrees > 90 ? -of_degrees(degrees - 90).sine.high : of_degrees(90 - degrees).sine.high)
                      : of_degrees(degrees).cosine.high;
}

double tangent_of_degrees(double degrees) {
  const bool is_steep = degrees > 45;
  const DoubledSineCosine found = of_degrees(is_steep ? 90 - degrees : degrees);
  return is_steep ? quotient(found.cosine, found.sine) : quotient(found.sine, found.cosine);
}

double cosine_of_small_angle(double radians) { return sine_and_cosine({radians}).cosine.high; }

// Computes twice the angle whose sine is the root of (1 - cosine) / 2, by Newton's method.
double arc_cosine(double cosine) {
  const double square = 0.5 * (1 - cosine);
  if (square <= 0) return 0;
  const double root = std::sqrt(square);
  const Doubled root_squared = exact_product(root, root);
  const Doubled sine{root, 0.5 * ((square - root_squared.high) - root_squared.low) / root};
  Doubled angle{root + root * square / 6};
  constexpr int steps = 4;  // each doubles the correct digits, from 2
  for (int i = 0; i < steps; ++i) {
    const DoubledSineCosine at = sine_and_cosine(angle);
    const double missing = (sine.high - at.sine.high) + (sine.low - at.sine.low);
    angle = exact_sum(angle.high, angle.low + missing / at.cosine.high);
  }
  return 2 * angle.high;
}

}  // namespace papilio
