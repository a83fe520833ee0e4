#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "server/http/http.h"

namespace papilio::server {

enum class LogFormat { text, json };

/// Directs spdlog's default logger to standard error, at `level` ("debug", "info", "warning", "error", "off"), as
/// key=value or as one JSON object per line.
void start_log(const std::string& level, LogFormat format);

/// Name and value in a line of the log about an event other than a request, such as "start".
struct Fact {
  Fact(std::string_view fact, std::string text) : name(fact), value(std::move(text)) {}
  template <class Number>
  requires std::is_arithmetic_v<Number> Fact(std::string_view fact, Number number)
      : name(fact), value(number_text(static_cast<double>(number))), is_number(true) {}

  std::string_view name;
  std::string value;
  bool is_number = false;

 private:
  static std::string number_text(double number);  ///< formats with three decimal places
};
void log_event(std::string_view level, std::string_view event, const std::vector<Fact>& facts);

/// Logs one structured line per request: id, method, path, status, milliseconds, bytes in and out, remote address, name
/// of the key and trace id if any, and the problem. Successful health checks are logged at debug level only.
void log_request(const Finished& request);

}  // namespace papilio::server
