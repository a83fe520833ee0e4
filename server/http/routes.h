#pragma once

#include <map>
#include <string>

#include "server/http/http.h"

namespace papilio::server {

struct Route {
  Handler handler;
  RouteOptions options;
};

/// The route of one request.
struct RouteMatch {
  const Route* route = nullptr;
  std::string pattern;  ///< the path as it was added
  Fields parameters{};  ///< what stands in the places of its `{name}` segments
};

/// Which handler answers what. Filled before the server runs, then read by all threads.
class Routes {
 public:
  Routes() = default;
  Routes(const Routes&) = delete;
  Routes& operator=(const Routes&) = delete;

  /// A segment `{name}` of the path matches any segment that is not empty; paths without one are preferred.
  void add(const std::string& method, const std::string& path, Handler handler, const RouteOptions& options);
  /// HEAD is answered by GET's handler, OPTIONS by a list of the path's methods unless a handler of its own
  /// was added. Throws not_found or method_not_allowed.
  [[nodiscard]] RouteMatch find(const std::string& method, const std::string& path) const;
  /// The value of `Allow` for a path: "GET, HEAD, OPTIONS".
  [[nodiscard]] std::string allowed(const std::string& path) const;

 private:
  using Methods = std::map<std::string, Route>;
  using Paths = std::map<std::string, Methods>;
  [[nodiscard]] Paths::const_iterator find_path(const std::string& path, Fields& parameters) const;

  Paths routes_;  ///< path, then method
};

}  // namespace papilio::server
