#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "server/engine.h"

namespace papilio::server {

/// A reference to one of the document's components, as "schemas/Problem".
[[nodiscard]] nlohmann::ordered_json reference_to(const std::string& component);
/// "view.eye" is "view_eye" among the components, whose names have no dots by custom.
[[nodiscard]] std::string component_name(std::string_view parameter);
/// The parameters of a refinement as those of a query: components by name.
[[nodiscard]] nlohmann::ordered_json openapi_parameters();
/// All schemas by name; among them the parameters as one JSON object, dots being levels.
[[nodiscard]] nlohmann::ordered_json openapi_schemas(const EngineOptions& options);

}  // namespace papilio::server
