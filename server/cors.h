#pragma once

#include <string>
#include <vector>

#include "server/http/http.h"

namespace papilio::server {

/// Cross-origin requests of browsers (the Fetch standard's CORS protocol). Off while no origin is allowed.
class Cors {
 public:
  /// `origins`: "https://example.org", or "*" for all of them. Throws std::runtime_error for what is no origin.
  explicit Cors(std::vector<std::string> origins);

  /// Adds what a page of an allowed origin needs to be shown the answer, and to the answer of an OPTIONS request what
  /// it needs to send the real one.
  void decorate(const Request& request, Response& response) const;

 private:
  [[nodiscard]] bool allows(const std::string& origin) const;
  std::vector<std::string> origins_;
};

}  // namespace papilio::server
