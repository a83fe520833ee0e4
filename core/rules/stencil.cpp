#include "rules/stencil.h"

namespace papilio::stencil {

Interior interior(uint32_t valence) {
  const auto k = static_cast<double>(valence);
  switch (valence) {
    case 2:
      return {0.5, {0.5, 0}};
    case 3:
      return {interior_centre, {5.0 / 12, -1.0 / 12, -1.0 / 12}};
    case 4:
      return {interior_centre, {3.0 / 8, 0, -1.0 / 8, 0}};
    default:
      break;
  }
  Interior weights{interior_centre, std::vector<double>(valence)};
  for (uint64_t j = 0; j < valence; ++j)
    weights.ring[j] =
        (harmonic_0 + harmonic_1 * cosine_of_turn(j, valence) + harmonic_2 * cosine_of_turn(2 * j, valence)) / k;
  return weights;
}

CurveRule::CurveRule(uint32_t triangles)
    : triangles_(triangles), angles_(sines_and_cosines_of_turn(triangles, uint64_t{2} * triangles)) {
  const uint64_t turn = uint64_t{4} * triangles;  // in halves of t = pi / K
  // sin t / (1 - cos t) = cot(t / 2) and cos t - cos 2t = 2 sin(3t / 2) sin(t / 2), which keep their digits at large K.
  of_centre_ = triangles_ * tangent_of_turn(1, turn);
  of_end_ = sine_of_turn(4, turn);
  over_end_ = 8 * triangles_ * sine_of_turn(3, turn) * sine_of_turn(1, turn);
}

CurveSpoke CurveRule::spoke(uint32_t i) const {
  const auto [sine, cosine] = angles_[i];
  const double sine_of_twice = this->sine(2 * i);
  return {1 - sine / of_centre_, cosine / 4 - of_end_ * sine_of_twice / over_end_, sine / triangles_,
          sine_of_twice / (2 * triangles_)};
}

}  // namespace papilio::stencil
