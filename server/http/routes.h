#pragma once

#include <map>
#include <string>

#include "server/http/http.h"

namespace papilio::server {

struct Route {
  Handler handler;
  WhileDraining while_draining = WhileDraining::answer;
};

/// Which handler answers what: exact paths, no patterns. Filled before the server runs, then read by all
/// threads.
class Routes {
 public:
  Routes() = default;
  Routes(const Routes&) = delete;
  Routes& operator=(const Routes&) = delete;

  void add(const std::string& method, const std::string& path, Handler handler, WhileDraining while_draining);
  /// HEAD is answered by GET's handler, OPTIONS by a list of the path's methods unless a handler of its own
  /// was added. Throws not_found or method_not_allowed.
  [[nodiscard]] const Route& find(const std::string& method, const std::string& path) const;
  /// The value of `Allow` for a path: "GET, HEAD, OPTIONS".
  [[nodiscard]] std::string allowed(const std::string& path) const;

 private:
  std::map<std::string, std::map<std::string, Route>> routes_;  ///< path, then method
};

}  // namespace papilio::server
