#include "stencil.h"

#include <cmath>
#include <numbers>

namespace papilio::stencil {

using std::numbers::pi;

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
  for (uint32_t j = 0; j < valence; ++j) {
    const double angle = 2 * pi * j / k;
    weights.ring[j] = (harmonic_0 + harmonic_1 * std::cos(angle) + harmonic_2 * std::cos(2 * angle)) / k;
  }
  return weights;
}

CurveSpoke curve_spoke(uint32_t triangles, uint32_t spoke) {
  const auto k = static_cast<double>(triangles);
  const double theta = pi / k;
  const double i = spoke;
  // sin t / (1 - cos t) = cot(t / 2) and cos t - cos 2t = 2 sin(3t / 2) sin(t / 2), which keep their digits at large K.
  const double centre = 1 - std::sin(i * theta) / (k * std::tan(theta / 2));
  const double end = std::cos(i * theta) / 4 - std::sin(2 * theta) * std::sin(2 * i * theta) /
                                                   (8 * k * std::sin(1.5 * theta) * std::sin(theta / 2));
  return {centre, end, std::sin(i * theta) / k, std::sin(2 * i * theta) / (2 * k)};
}

std::vector<double> curve_weights(uint32_t triangles, uint32_t spoke) {
  const CurveSpoke rule = curve_spoke(triangles, spoke);
  const double theta = pi / triangles;
  std::vector<double> weights{rule.centre, rule.end};
  for (uint32_t j = 1; j < triangles; ++j)
    weights.push_back(rule.sine_1 * std::sin(j * theta) + rule.sine_2 * std::sin(2 * j * theta));
  weights.push_back(-rule.end);
  return weights;
}

}  // namespace papilio::stencil
