#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/engine.h"
#include "server/http/http.h"
#include "server/log.h"

namespace papilio::server {

/// Everything that an operator can set. Each setting has a flag and an environment twin (`--max-body-bytes`,
/// `PAPILIO_MAX_BODY_BYTES`): default, then environment, then flag.
struct Config {
  HttpOptions http;
  EngineOptions engine;
  std::string keys;                       ///< file of keys; empty: none are asked for
  bool allow_open = false;                ///< listen beyond loopback without keys
  std::vector<std::string> cors_origins;  ///< whose pages may use the service
  uint64_t max_memory_bytes = 0;          ///< address space of the process; 0: as much as the other settings may need
  uint64_t container_memory_bytes = 0;    ///< memory that the container has; 0: no limit
  int drain_seconds = 30;                 ///< longest wait for running requests after SIGTERM
  std::string log_level = "info";
  LogFormat log_format = LogFormat::text;
};

/// How `parse_config` ended.
struct ConfigOutcome {
  Config config;
  bool exit = false;  ///< the program is to end now, with `status`: help or version shown, or a setting refused
  int status = 0;     ///< 0, or 2 for bad usage
};

/// Reads the environment and the command line, and validates. Help goes to standard output; a refusal, which
/// names the setting and its range, to standard error.
[[nodiscard]] ConfigOutcome parse_config(int argc, const char* const* argv);

}  // namespace papilio::server
