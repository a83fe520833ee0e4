#pragma once

#include <random>
#include <string>

#include "proto/parameters.h"

namespace papilio::soak {

/// A query that every mesh about the origin can be refined with: any of the schemes, criteria and forms of the answer.
[[nodiscard]] std::string random_query(std::mt19937& random, int most_levels);

/// The fields of a query in which nothing is encoded.
[[nodiscard]] proto::QueryFields fields_of(const std::string& query);

}  // namespace papilio::soak
