#pragma once

#include <string>
#include <vector>

#include "server/http/http.h"

namespace papilio::server {

/// Cross-origin requests of browsers (CORS protocol of the Fetch standard). Off if no origin is allowed.
class Cors {
 public:
  /// Allows `origins`: "https://example.org", or "*" for all. Throws std::runtime_error for an invalid origin.
  explicit Cors(std::vector<std::string> origins);

  /// Adds the headers that permit a page of an allowed origin to read the answer; and in the answer to OPTIONS, those
  /// that permit it to send the actual request.
  void decorate(const Request& request, Response& response) const;

 private:
  [[nodiscard]] bool allows(const std::string& origin) const;
  std::vector<std::string> origins_;
};

}  // namespace papilio::server
