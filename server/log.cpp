#include "server/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "proto/text.h"

namespace papilio::server {
namespace {

LogFormat format_in_use = LogFormat::text;  // set once, before any thread is started

/// Returns a quoted value that cannot be confused with the next field.
std::string in_quotes(std::string_view text) {
  constexpr size_t longest = 400;
  std::string out = "\"";
  for (char c : text.substr(0, longest)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c >= ' ' && c <= '~' ? c : '?';
  }
  return out + (text.size() > longest ? "...\"" : "\"");
}

bool is_plain(std::string_view text) {
  return !text.empty() && text.size() <= 80 && std::ranges::all_of(text, [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '_' ||
           c == '-' || c == ':';
  });
}

std::string as_text(std::string_view event, const std::vector<Fact>& facts) {
  std::string line = "msg=";
  line += event;
  for (const Fact& fact : facts) {
    line += ' ';
    line += fact.name;
    line += '=';
    line += is_plain(fact.value) ? fact.value : in_quotes(fact.value);
  }
  return line;
}

/// Returns the members that follow time and level of spdlog's pattern.
std::string as_json(std::string_view event, const std::vector<Fact>& facts) {
  nlohmann::ordered_json document{{"msg", event}};
  for (const Fact& fact : facts) {
    auto& member = document[std::string(fact.name)];
    member = fact.value;
    if (fact.is_number) member = nlohmann::ordered_json::parse(fact.value);
  }
  return document.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace).substr(1);
}

void write(spdlog::level::level_enum level, std::string_view event, const std::vector<Fact>& facts) {
  if (!spdlog::should_log(level)) return;
  spdlog::log(level, "{}", format_in_use == LogFormat::json ? as_json(event, facts) : as_text(event, facts));
}

}  // namespace

std::string Fact::number_text(double number) { return proto::format_number(std::round(number * 1000) / 1000); }

void start_log(const std::string& level, LogFormat format) {
  format_in_use = format;
  auto logger = spdlog::stderr_logger_mt("papilio");
  logger->set_pattern(format == LogFormat::json ? R"({"time":"%Y-%m-%dT%H:%M:%S.%e%z","level":"%l",%v)"
                                                : "%Y-%m-%dT%H:%M:%S.%e%z level=%l %v");
  logger->set_level(spdlog::level::from_str(level));
  logger->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(logger);
}

void log_event(std::string_view level, std::string_view event, const std::vector<Fact>& facts) {
  write(spdlog::level::from_str(std::string(level)), event, facts);
}

void log_request(const Finished& request) {
  spdlog::level::level_enum level = spdlog::level::info;
  if (request.status >= 500) level = spdlog::level::err;
  if (request.status < 400 && (request.path == "/health" || request.path == "/ready")) level = spdlog::level::debug;
  std::vector<Fact> facts{{"id", request.id},           {"method", proto::shorten(request.method)},
                          {"path", request.path},       {"status", request.status},
                          {"ms", request.milliseconds}, {"in", request.bytes_in},
                          {"out", request.bytes_out},   {"remote", request.remote_address}};
  if (!request.client.empty()) facts.emplace_back("client", request.client);
  if (!request.trace.empty()) facts.emplace_back("trace", request.trace);
  if (!request.code.empty()) facts.insert(facts.end(), {Fact{"code", request.code}, Fact{"detail", request.detail}});
  write(level, "request", facts);
}

}  // namespace papilio::server
