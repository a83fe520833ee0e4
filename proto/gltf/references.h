#pragma once

#include <cstdint>
#include <vector>

#include "proto/gltf/json.h"

// Which accessors and views are needed once geometry is replaced.

namespace papilio::proto::gltf {

/// A primitive whose geometry is replaced.
struct PrimitivePlace {
  uint32_t mesh = 0, primitive = 0;
};

/// What only replaced primitives refer to.
struct Released {
  std::vector<bool> accessors;
  std::vector<bool> views;               ///< of released accessors, replaced Draco streams and their residuals alone
  std::vector<bool> views_of_accessors;  ///< needed by dense accessors alone, released or not
};

/// Finds what the replacement releases. An accessor or view that nothing refers to is not released: it may be known to
/// an extension.
[[nodiscard]] Released find_released(const Json& document, const std::vector<PrimitivePlace>& replaced);

/// Finds the views that only the residuals of packed models refer to (PAPILIO_detail).
[[nodiscard]] std::vector<uint32_t> find_detail_views(const Json& document);

}  // namespace papilio::proto::gltf
