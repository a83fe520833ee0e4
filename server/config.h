#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/engine.h"
#include "server/http/http.h"
#include "server/log.h"

namespace papilio::server {

/// Settings of the operator. Each has a flag and an environment variable (`--max-body-bytes`,
/// `PAPILIO_MAX_BODY_BYTES`). A flag overrides the environment, which overrides the default.
struct Config {
  HttpOptions http;
  EngineOptions engine;
  std::string keys;                       ///< file of keys; empty: no keys are required
  bool allow_open = false;                ///< whether to listen beyond loopback without keys
  std::vector<std::string> cors_origins;  ///< origins whose pages may use the service
  uint64_t max_memory_bytes = 0;          ///< address space of the process; 0: bound of the other settings
  uint64_t container_memory_bytes = 0;    ///< memory of the container; 0: no limit
  int drain_seconds = 30;                 ///< longest wait for running requests after SIGTERM
  std::string log_level = "info";
  LogFormat log_format = LogFormat::text;
};

/// Outcome of parse_config().
struct ConfigOutcome {
  Config config;
  bool exit = false;  ///< whether to exit now with `status`: help or version was shown, or a setting refused
  int status = 0;     ///< exit status: 0, or 2 for bad usage
};

/// Reads and validates the environment and the command line. Prints help to standard output, and a refusal, with the
/// setting and its range, to standard error.
[[nodiscard]] ConfigOutcome parse_config(int argc, const char* const* argv);

}  // namespace papilio::server
