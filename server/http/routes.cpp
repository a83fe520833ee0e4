#include "server/http/routes.h"

#include <algorithm>

namespace papilio::server {

using proto::Code;
using proto::Problem;

namespace {

/// Consumes the first segment of the path and its slash.
std::string_view take_segment(std::string_view& path) {
  path.remove_prefix(1);
  const std::string_view segment = path.substr(0, path.find('/'));
  path.remove_prefix(segment.size());
  return segment;
}

bool matches(std::string_view pattern, std::string_view path, Fields& parameters) {
  parameters.clear();
  while (pattern.starts_with('/') && path.starts_with('/')) {
    const std::string_view place = take_segment(pattern);
    const std::string_view segment = take_segment(path);
    if (place.starts_with('{') && place.ends_with('}') && !segment.empty())
      parameters.emplace_back(place.substr(1, place.size() - 2), segment);
    else if (place != segment)
      return false;
  }
  return pattern.empty() && path.empty();
}

}  // namespace

void Routes::add(const std::string& method, const std::string& path, Handler handler, const RouteOptions& options) {
  Methods& methods = routes_[path];
  methods[method] = {std::move(handler), options};
  if (method == "GET") methods.try_emplace("HEAD", methods["GET"]);
  const auto list_methods = [this, path](Request&) {
    Response response;
    response.status = 204;
    response.headers.emplace_back("Allow", allowed(path));
    return response;
  };
  methods.try_emplace("OPTIONS", Route{list_methods, {.while_draining = WhileDraining::answer}});
}

Routes::Paths::const_iterator Routes::find_path(const std::string& path, Fields& parameters) const {
  const auto exact = routes_.find(path);
  if (exact != routes_.end() && path.find('{') == std::string::npos) return exact;
  return std::ranges::find_if(routes_, [&](const auto& route) { return matches(route.first, path, parameters); });
}

RouteMatch Routes::find(const std::string& method, const std::string& path) const {
  RouteMatch match;
  const auto found = find_path(path, match.parameters);
  if (found == routes_.end()) throw Problem(Code::not_found, "No resource exists at this path.");
  const auto route = found->second.find(method);
  if (route == found->second.end()) throw Problem(Code::method_not_allowed, "This path takes " + allowed(path) + ".");
  match.route = &route->second;
  match.pattern = found->first;
  return match;
}

std::string Routes::allowed(const std::string& path) const {
  std::string list;
  Fields parameters;
  const auto found = find_path(path, parameters);
  if (found == routes_.end()) return list;
  for (const auto& [method, answered] : found->second) list += (list.empty() ? "" : ", ") + method;
  return list;
}

}  // namespace papilio::server
