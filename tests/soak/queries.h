#pragma once

#include <random>
#include <string>

#include "proto/parameters.h"

namespace papilio::soak {

/// Returns a query that is valid for every mesh around the origin, with any scheme, criteria and answer format.
[[nodiscard]] std::string random_query(std::mt19937& random, int most_levels);

/// Returns the fields of a query without percent-encoding.
[[nodiscard]] proto::QueryFields fields_of(const std::string& query);

}  // namespace papilio::soak
