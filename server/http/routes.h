#pragma once

#include <map>
#include <string>

#include "server/http/http.h"

namespace papilio::server {

struct Route {
  Handler handler;
  RouteOptions options;
};

/// Route of one request.
struct RouteMatch {
  const Route* route = nullptr;
  std::string pattern;  ///< path of the route
  Fields parameters{};  ///< values of its `{name}` segments
};

/// Table of routes. Filled before the server runs, then read by all threads.
class Routes {
 public:
  Routes() = default;
  Routes(const Routes&) = delete;
  Routes& operator=(const Routes&) = delete;

  /// Adds a route. A segment `{name}` of the path matches any non-empty segment; paths without one have priority.
  void add(const std::string& method, const std::string& path, Handler handler, const RouteOptions& options);
  /// Finds the route of a request. HEAD uses GET's handler; OPTIONS without a handler lists the path's methods. Throws
  /// `Problem` not_found or method_not_allowed.
  [[nodiscard]] RouteMatch find(const std::string& method, const std::string& path) const;
  /// Returns the value of `Allow` for a path: "GET, HEAD, OPTIONS".
  [[nodiscard]] std::string allowed(const std::string& path) const;

 private:
  using Methods = std::map<std::string, Route>;
  using Paths = std::map<std::string, Methods>;
  [[nodiscard]] Paths::const_iterator find_path(const std::string& path, Fields& parameters) const;

  Paths routes_;  ///< [path][method]
};

}  // namespace papilio::server
