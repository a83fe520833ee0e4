#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "server/engine.h"

namespace papilio::server {

/// Returns a reference to one of the document's components, such as "schemas/Problem".
[[nodiscard]] nlohmann::ordered_json reference_to(const std::string& component);
/// Returns the component name of a parameter, without dots: "view_eye" for "view.eye".
[[nodiscard]] std::string component_name(std::string_view parameter);
/// Returns the parameters of a refinement as query parameters: components by name.
[[nodiscard]] nlohmann::ordered_json openapi_parameters();
/// Returns all schemas by name, including the parameters as one JSON object, nested at dots.
[[nodiscard]] nlohmann::ordered_json openapi_schemas(const EngineOptions& options);

}  // namespace papilio::server
