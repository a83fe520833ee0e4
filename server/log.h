#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "server/http/http.h"

namespace papilio::server {

enum class LogFormat { text, json };

/// Sends spdlog's default logger to standard error, at this level ("debug", "info", "warning", "error", "off"), as
/// key=value or with one JSON object a line.
void start_log(const std::string& level, LogFormat format);

/// One line about something other than a request, such as "start", with its facts.
struct Fact {
  Fact(std::string_view fact, std::string text) : name(fact), value(std::move(text)) {}
  template <class Number>
  requires std::is_arithmetic_v<Number> Fact(std::string_view fact, Number number)
      : name(fact), value(number_text(static_cast<double>(number))), is_number(true) {}

  std::string_view name;
  std::string value;
  bool is_number = false;

 private:
  static std::string number_text(double number);  ///< to a thousandth
};
void log_event(std::string_view level, std::string_view event, const std::vector<Fact>& facts);

/// One structured line a request: id, method, path, status, milliseconds, bytes in and out, remote address, the key's
/// name and the trace id where there are any, and what went wrong. Successful health questions are logged at debug
/// level only.
void log_request(const Finished& request);

}  // namespace papilio::server
