#include "server/cors.h"

#include <algorithm>
#include <stdexcept>

#include "server/http/head.h"

namespace papilio::server {
namespace {

constexpr const char* readable_headers =
    "ETag, Location, Retry-After, Server-Timing, X-Request-Id, Papilio-Vertices, Papilio-Faces, Papilio-Levels, "
    "Papilio-Stop-Reason, Papilio-Error, Papilio-Error-Pixels, Papilio-Unreached, Papilio-Shape, Papilio-Found";
constexpr const char* sendable_headers =
    "Accept, Authorization, Content-Type, If-None-Match, X-Request-Id, traceparent, tracestate";
constexpr const char* preflight_seconds = "86400";

bool is_origin(const std::string& text) {
  const size_t mark = text.find("://");
  return text == "*" || (mark != std::string::npos && mark > 0 && mark + 3 < text.size() &&
                         text.find_first_of("/ ?#,", mark + 3) == std::string::npos);
}

/// Adds a field to the header `Vary`.
void add_to_vary(Response& response, const std::string& field) {
  for (auto& [name, value] : response.headers) {
    if (!same_ignoring_case(name, "Vary")) continue;
    value += ", " + field;
    return;
  }
  response.headers.emplace_back("Vary", field);
}

}  // namespace

Cors::Cors(std::vector<std::string> origins) : origins_(std::move(origins)) {
  for (const std::string& origin : origins_)
    if (!is_origin(origin))
      throw std::runtime_error(
          "--cors-origins (PAPILIO_CORS_ORIGINS) takes origins such as https://example.org, or *; not " + origin);
}

bool Cors::allows(const std::string& origin) const {
  return std::ranges::any_of(origins_, [&](const std::string& known) { return known == "*" || known == origin; });
}

void Cors::decorate(const Request& request, Response& response) const {
  if (origins_.empty()) return;
  add_to_vary(response, "Origin");
  const std::string origin = request.header("Origin");
  if (origin.empty() || !allows(origin)) return;
  auto& headers = response.headers;
  headers.emplace_back("Access-Control-Allow-Origin", origin);
  headers.emplace_back("Access-Control-Expose-Headers", readable_headers);
  if (request.method() != "OPTIONS" || request.header("Access-Control-Request-Method").empty()) return;
  for (const auto& [name, value] : Fields(headers))
    if (name == "Allow") headers.emplace_back("Access-Control-Allow-Methods", value);
  headers.emplace_back("Access-Control-Allow-Headers", sendable_headers);
  headers.emplace_back("Access-Control-Max-Age", preflight_seconds);
}

}  // namespace papilio::server
