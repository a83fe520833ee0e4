#include "server/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "proto/text.h"

namespace papilio::server {

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
  if (request.status < 400 && (request.path == "/health" || request.path == "/ready"))
    level = spdlog::level::debug;
  std::string trouble;
  if (!request.code.empty()) trouble = " code=" + request.code + " detail=" + proto::quote(request.detail);
  spdlog::log(level, "msg=request id={} method={} path={} status={} ms={:.3f} in={} out={} remote={}{}",
              request.id, proto::shorten(request.method), proto::quote(request.path), request.status,
              request.milliseconds, request.bytes_in, request.bytes_out, request.remote_address, trouble);
}

}  // namespace papilio::server
