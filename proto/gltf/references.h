#pragma once

#include <cstdint>
#include <vector>

#include "proto/gltf/json.h"

// Accessors and views that are still referenced after geometry is replaced.

namespace papilio::proto::gltf {

/// Primitive whose geometry is replaced.
struct PrimitivePlace {
  uint32_t mesh = 0, primitive = 0;
};

/// Accessors and views that only replaced primitives refer to.
struct Released {
  std::vector<bool> accessors;
  std::vector<bool> views;  ///< used only by released accessors, replaced Draco streams and their residuals
  std::vector<bool> views_of_accessors;  ///< used only by dense accessors, released or not
};

/// Finds the accessors and views that the replacement releases. Unreferenced ones are not released: an extension may
/// use them.
[[nodiscard]] Released find_released(const Json& document, const std::vector<PrimitivePlace>& replaced);

/// Finds the views that only the residuals of packed models refer to (PAPILIO_detail).
[[nodiscard]] std::vector<uint32_t> find_detail_views(const Json& document);

}  // namespace papilio::proto::gltf
