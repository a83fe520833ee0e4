#pragma once

#include <draco/compression/attributes/normal_compression_utils.h>
#include <draco/core/quantization_utils.h>

#include <cstdint>
#include <vector>

#include "proto/output_attribute.h"

namespace papilio::proto::edgebreaker {

/// Quantizer of one attribute that is not coded raw: bit-identical to libdraco's.
class AttributeQuantizer {
 public:
  explicit AttributeQuantizer(const OutputAttribute& attribute);

  /// Returns the number of integers of a value.
  [[nodiscard]] uint32_t components() const {
    return attribute_.coding == Coding::octahedral ? 2 : attribute_.components;
  }
  /// Appends the integers of a value of StoredValues.
  void append(const char* bytes, std::vector<int32_t>& out);

 private:
  const OutputAttribute& attribute_;
  draco::OctahedronToolBox octahedron_;
  draco::Quantizer grid_;
  std::vector<float> floats_;
};

}  // namespace papilio::proto::edgebreaker
