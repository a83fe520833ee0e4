#include "proto/edgebreaker/attribute_quantizer.h"

#include <cstring>

#include "proto/draco_attributes.h"

namespace papilio::proto::edgebreaker {
namespace {

template <class Number>
void append_integers(const OutputAttribute& attribute, const char* bytes, std::vector<int32_t>& out) {
  for (uint32_t i = 0; i < attribute.components; ++i) {
    Number number;
    std::memcpy(&number, bytes + i * sizeof number, sizeof number);
    out.push_back(static_cast<int32_t>(number));
  }
}

}  // namespace

AttributeQuantizer::AttributeQuantizer(const OutputAttribute& attribute) : attribute_(attribute) {
  if (attribute.coding == Coding::octahedral) octahedron_.SetQuantizationBits(attribute.bits);
  if (attribute.coding == Coding::grid) grid_.Init(attribute.grid.range, (1 << attribute.bits) - 1);
}

void AttributeQuantizer::append(const char* bytes, std::vector<int32_t>& out) {
  if (attribute_.coding == Coding::integers) {
    with_number(attribute_.format.type, [&](auto zero) { append_integers<decltype(zero)>(attribute_, bytes, out); });
    return;
  }
  floats_.resize(attribute_.components);
  std::memcpy(floats_.data(), bytes, floats_.size() * sizeof(float));
  if (attribute_.coding == Coding::octahedral) {
    int32_t s = 0;
    int32_t t = 0;
    octahedron_.FloatVectorToQuantizedOctahedralCoords(floats_.data(), &s, &t);
    out.insert(out.end(), {s, t});
  } else {
    for (uint32_t i = 0; i < floats_.size(); ++i)
      out.push_back(grid_.QuantizeFloat(floats_[i] - attribute_.grid.origin[i]));
  }
}

}  // namespace papilio::proto::edgebreaker
