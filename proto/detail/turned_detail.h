#pragma once

#include <memory>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// Returns a detail with its texture coordinates turned over, to count upwards (packed_texcoords.h).
[[nodiscard]] std::shared_ptr<const Detail> turned_over(std::shared_ptr<const Detail> detail);

}  // namespace papilio::proto::detail
