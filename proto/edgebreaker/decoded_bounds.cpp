#include "proto/edgebreaker/decoded_bounds.h"

#include <draco/compression/attributes/normal_compression_utils.h>
#include <draco/core/quantization_utils.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "proto/draco_attributes.h"
#include "proto/edgebreaker/attribute_quantizer.h"

namespace papilio::proto::edgebreaker {
namespace {

/// Decoder of single values as libdraco decodes them from a stream.
class ValueDecoder {
 public:
  explicit ValueDecoder(const OutputAttribute& attribute)
      : attribute_(attribute), quantizer_(attribute), numbers_(attribute.components) {
    if (attribute.coding == Coding::octahedral) octahedron_.SetQuantizationBits(attribute.bits);
    if (attribute.coding == Coding::grid) grid_.Init(attribute.grid.range, (1 << attribute.bits) - 1);
  }

  /// Returns the numbers of a stored value, which are valid until the next call.
  const std::vector<double>& decode(const char* bytes) {
    if (attribute_.coding == Coding::grid || attribute_.coding == Coding::octahedral)
      decode_floats(bytes);
    else
      with_number(attribute_.format.type, [&](auto zero) { read<decltype(zero)>(bytes); });
    return numbers_;
  }

 private:
  template <class Number>
  void read(const char* bytes) {
    for (size_t i = 0; i < numbers_.size(); ++i) {
      Number number;
      std::memcpy(&number, bytes + i * sizeof number, sizeof number);
      numbers_[i] = static_cast<double>(number);
    }
  }

  void decode_floats(const char* bytes) {
    integers_.clear();
    quantizer_.append(bytes, integers_);
    if (attribute_.coding == Coding::octahedral) {
      std::array<float, 3> unit{};
      octahedron_.QuantizedOctahedralCoordsToUnitVector(integers_[0], integers_[1], unit.data());
      numbers_.assign(unit.begin(), unit.end());
    } else {
      for (size_t i = 0; i < numbers_.size(); ++i)
        numbers_[i] = grid_.DequantizeFloat(integers_[i]) + attribute_.grid.origin[i];
    }
  }

  const OutputAttribute& attribute_;
  AttributeQuantizer quantizer_;
  draco::OctahedronToolBox octahedron_;
  draco::Dequantizer grid_;
  std::vector<int32_t> integers_;
  std::vector<double> numbers_;  ///< [components]
};

}  // namespace

NumberBounds decoded_bounds(const OutputAttribute& attribute) {
  ValueDecoder decoder(attribute);
  const std::vector<char>& bytes = attribute.values.bytes;
  const size_t stride = size_t{attribute.components} * draco::DataTypeLength(draco_type(attribute.format.type));
  NumberBounds bounds;
  for (size_t at = 0; at < bytes.size(); at += stride) {
    const std::vector<double>& numbers = decoder.decode(&bytes[at]);
    if (at == 0) bounds = {numbers, numbers};
    for (size_t i = 0; i < numbers.size(); ++i) {
      bounds.low[i] = std::min(bounds.low[i], numbers[i]);
      bounds.high[i] = std::max(bounds.high[i], numbers[i]);
    }
  }
  return bounds;
}

}  // namespace papilio::proto::edgebreaker
