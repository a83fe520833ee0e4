#pragma once

#include <vector>

#include "proto/output_attribute.h"

namespace papilio::proto::edgebreaker {

/// Lowest and highest numbers of an attribute.
struct NumberBounds {
  std::vector<double> low, high;  ///< [components]
};

/// Returns the bounds of the numbers that a reader decodes, to the bit, in no memory beside the attribute. Each stored
/// value must be that of a corner.
[[nodiscard]] NumberBounds decoded_bounds(const OutputAttribute& attribute);

}  // namespace papilio::proto::edgebreaker
