#pragma once

#include <string>

#include "proto/limits.h"
#include "server/http/http.h"

namespace papilio::server {

/// Everything that an operator can set. Each setting has a flag and an environment twin (`--max-body-bytes`,
/// `PAPILIO_MAX_BODY_BYTES`): default, then environment, then flag.
struct Config {
  HttpOptions http;
  proto::Limits limits;
  int slots = 0;           ///< requests computed at once; 0: one a core
  int queue = 16;          ///< requests that may wait for a slot; more are refused with 429
  int drain_seconds = 30;  ///< longest wait for running requests after SIGTERM
  std::string log_level = "info";
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
