#include "mesh/blended_points.h"

#include <algorithm>
#include <cmath>

#include "mesh/attributes.h"

namespace papilio {
namespace {

constexpr double rounding = 1e-5;  // share of an attribute's largest value at the two points

/// Interpolates the values of two points, and normalizes them if the attribute is of unit length.
std::vector<double> blend(const Attribute& attribute, uint32_t p, uint32_t q, double share) {
  std::vector<double> values;
  double squared = 0;
  for (uint32_t i = 0; i < attribute.components; ++i) {
    const double from = values_of(attribute, p)[i];
    const double to = values_of(attribute, q)[i];
    values.push_back(from == to ? from : (1 - share) * from + share * to);
    squared += values.back() * values.back();
  }
  if (attribute.unit_length && squared > 0)
    for (double& value : values) value /= std::sqrt(squared);
  return values;
}

bool is_nearly(const Attribute& attribute, uint32_t point, const std::vector<double>& values) {
  double largest = 0, apart = 0;
  for (uint32_t i = 0; i < attribute.components; ++i) {
    const double value = values_of(attribute, point)[i];
    largest = std::max({largest, std::abs(value), std::abs(values[i])});
    apart = std::max(apart, std::abs(value - values[i]));
  }
  return apart <= rounding * largest;
}

}  // namespace

void BlendedPoints::extend() {
  if (is_extended_) return;
  check_attributes(input_);
  extended_.positions = input_.positions;
  extended_.attributes = input_.attributes;
  is_extended_ = true;
}

uint32_t BlendedPoints::between(uint32_t p, uint32_t q, double share, std::span<const uint32_t> known) {
  extend();
  std::vector<std::vector<double>> values;
  for (const Attribute& attribute : extended_.attributes) values.push_back(blend(attribute, p, q, share));
  for (const uint32_t point : known) {
    bool is_same = true;
    for (size_t a = 0; a < values.size(); ++a)
      is_same = is_same && is_nearly(extended_.attributes[a], point, values[a]);
    if (is_same) return point;
  }
  for (size_t a = 0; a < values.size(); ++a) {
    std::vector<double>& all = extended_.attributes[a].values;
    all.insert(all.end(), values[a].begin(), values[a].end());
  }
  extended_.positions.push_back({});
  return static_cast<uint32_t>(extended_.positions.size() - 1);
}

}  // namespace papilio
