#include "proto/gltf/element_summary.h"

#include <algorithm>

namespace papilio::proto::gltf {
namespace {

Json bound(const Elements& elements, bool upper) {
  std::vector<double> extremes(elements.format.components);
  for (uint32_t c = 0; c < extremes.size(); ++c) {
    double& extreme = extremes[c];
    extreme = elements.number(0, c);
    for (uint64_t i = 1; i < elements.count; ++i) {
      const double number = elements.number(i, c);
      extreme = upper ? std::max(extreme, number) : std::min(extreme, number);
    }
  }
  return declared_bound(elements.format.type, extremes);
}

}  // namespace

bool declares_bounds(const Json& document, std::optional<uint32_t> old) {
  if (!old) return false;
  const Json& accessor = element_of(document, "accessors", *old, "a primitive");
  return accessor.contains("min") || accessor.contains("max");
}

Json declared_bound(ComponentType type, const std::vector<double>& numbers) {
  Json out = Json::array();
  for (const double number : numbers) {
    if (type == ComponentType::float32)
      out.push_back(number);
    else
      out.push_back(static_cast<int64_t>(number));
  }
  return out;
}

ElementSummary summarize(const Json& document, std::optional<uint32_t> old, const Elements& elements) {
  ElementSummary summary{.accessor = old, .format = elements.format, .count = elements.count};
  if (elements.count > 0 && declares_bounds(document, old))
    summary.bounds.emplace(bound(elements, false), bound(elements, true));
  return summary;
}

Elements index_elements(const Buffer<Triangle>& triangles, uint64_t vertices) {
  const ComponentType type = vertices <= most_vertices_of_16_bits ? ComponentType::uint16 : ComponentType::uint32;
  Elements out = zero_elements({type, 1, false}, 3 * triangles.size());
  for (size_t i = 0; i < 3 * triangles.size(); ++i) out.set_number(i, 0, triangles[i / 3][i % 3]);
  return out;
}

}  // namespace papilio::proto::gltf
