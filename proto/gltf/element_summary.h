#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "papilio/mesh.h"
#include "proto/gltf/accessor.h"

namespace papilio::proto::gltf {

/// Description of an accessor's elements.
struct ElementSummary {
  std::optional<uint32_t> accessor{};  ///< old accessor; nothing for a new one
  ElementFormat format{};
  uint64_t count = 0;
  std::optional<std::pair<Json, Json>> bounds{};  ///< lowest and highest numbers, if the old accessor declares any
};

/// Returns whether the accessor `old` declares its lowest or highest numbers.
[[nodiscard]] bool declares_bounds(const Json& document, std::optional<uint32_t> old);

/// Returns the lowest or the highest numbers [components] in the form of an accessor of `type`.
[[nodiscard]] Json declared_bound(ComponentType type, const std::vector<double>& numbers);

/// Describes elements that replace those of the document's accessor `old`. Throws `Problem` mesh_not_gltf if there is
/// no such accessor.
[[nodiscard]] ElementSummary summarize(const Json& document, std::optional<uint32_t> old, const Elements& elements);

/// Returns the indices of triangles, in 16 bits if these suffice for `vertices`.
[[nodiscard]] Elements index_elements(const Buffer<Triangle>& triangles, uint64_t vertices);

}  // namespace papilio::proto::gltf
