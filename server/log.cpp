#include "server/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "proto/text.h"

namespace papilio::server {
namespace {

/// A quoted value in which nothing can be taken for the next field.
std::string log_value(std::string_view text) {
  constexpr size_t longest = 400;
  std::string out = "\"";
  for (char c : text.substr(0, longest)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c >= ' ' && c <= '~' ? c : '?';
  }
  return out + (text.size() > longest ? "...\"" : "\"");
}

}  // namespace

void start_log(const std::string& level) {
  auto logger = spdlog::stderr_logger_mt("papilio");
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z level=%l %v");
  logger->set_level(spdlog::level::from_str(level));
  logger->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(logger);
}

void log_request(const Finished& request) {
  spdlog::level::level_enum level = spdlog::level::info;
  if (request.status >= 500) level = spdlog::level::err;
  if (request.status < 400 && (request.path == "/health" || request.path == "/ready")) level = spdlog::level::debug;
  std::string trouble;
  if (!request.code.empty()) trouble = " code=" + request.code + " detail=" + log_value(request.detail);
  spdlog::log(level, "msg=request id={} method={} path={} status={} ms={:.3f} in={} out={} remote={}{}", request.id,
              proto::shorten(request.method), log_value(request.path), request.status, request.milliseconds,
              request.bytes_in, request.bytes_out, request.remote_address, trouble);
}

}  // namespace papilio::server
