#pragma once

#include <memory>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// Returns the same detail with texture coordinates that count upwards where its own count downwards.
[[nodiscard]] std::shared_ptr<const Detail> turned_over(std::shared_ptr<const Detail> detail);

}  // namespace papilio::proto::detail
