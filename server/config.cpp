#include "server/config.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <thread>

namespace papilio::server {
namespace {

std::string environment_twin(std::string flag) {
  std::ranges::replace(flag, '-', '_');
  std::ranges::transform(flag, flag.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return "PAPILIO_" + flag;
}

/// After a refusal: which settings came from the environment, since the refusal names flags only.
void name_environment_twins(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const char* value = option->get_envname().empty() ? nullptr : std::getenv(option->get_envname().c_str());
    if (value != nullptr) std::cerr << "The environment has " << option->get_envname() << '=' << value << '\n';
  }
}

/// One line a setting; the flag's name gives the environment's.
class Settings {
 public:
  explicit Settings(CLI::App& app) : app_(app) {}

  template <class Value>
  CLI::Option* add(const std::string& flag, Value& value, const std::string& description) {
    return app_.add_option("--" + flag, value, description)->envname(environment_twin(flag))->capture_default_str();
  }
  template <class Value>
  void add(const std::string& flag, Value& value, Value least, Value most, const std::string& description) {
    add(flag, value, description)->check(CLI::Range(least, most));
  }

 private:
  CLI::App& app_;
};

}  // namespace

ConfigOutcome parse_config(int argc, const char* const* argv) {
  ConfigOutcome outcome;
  Config& config = outcome.config;
  CLI::App app{"papilio-server: refines Draco meshes over HTTP where they are curved, visible and large on screen."};
  app.footer(
      "It prints `listening on http://HOST:PORT` on standard output and logs to standard error.\n"
      "SIGTERM or SIGINT lets running requests finish, then ends with status 0.");
  app.set_version_flag("--version", "papilio-server " PAPILIO_VERSION);
  app.option_defaults()->always_capture_default();

  constexpr uint64_t most_bytes = 4ULL << 30;
  constexpr uint64_t most_faces = 1ULL << 30;
  Settings settings(app);
  settings.add("host", config.http.host, "Address to listen on; 0.0.0.0 for all");
  settings.add("port", config.http.port, 0, 65535, "Port to listen on; 0 picks a free one");
  CLI::Option* const certificate =
      settings.add("tls-cert", config.http.tls_cert, "PEM file of a certificate and its intermediates: HTTPS only");
  settings.add("tls-key", config.http.tls_key, "PEM file of its key, without a passphrase")
      ->needs(certificate->check(CLI::ExistingFile))
      ->check(CLI::ExistingFile);
  certificate->needs("--tls-key");
  settings.add("max-body-bytes", config.http.max_body_bytes, uint64_t{1}, most_bytes, "Largest request body: 413");
  settings.add("max-header-bytes", config.http.max_header_bytes, uint64_t{1024}, uint64_t{1} << 20,
               "Longest request line and header fields together: 431");
  settings.add("max-input-faces", config.limits.max_input_faces, uint64_t{1}, most_faces,
               "Most faces of a mesh sent: 413");
  settings.add("max-input-vertices", config.limits.max_input_vertices, uint64_t{1}, most_faces,
               "Most vertices of a mesh sent: 413");
  settings.add("max-output-faces", config.limits.max_output_faces, uint64_t{1}, most_faces,
               "Most faces of a result: 507");
  settings.add("slots", config.slots, 0, 1024, "Requests computed at once; 0: one a core");
  settings.add("queue", config.queue, 0, 100000, "Requests that may wait for a slot; more are refused with 429");
  settings.add("connections", config.http.threads, 1, 10000, "Connections served at once");
  settings.add("idle-seconds", config.http.idle_seconds, 1, 3600, "An idle connection is closed after this");
  settings.add("read-seconds", config.http.read_seconds, 1, 3600, "Longest wait for the next bytes of a request");
  settings.add("write-seconds", config.http.write_seconds, 1, 3600, "Longest wait for a client to take more bytes");
  settings.add("drain-seconds", config.drain_seconds, 0, 3600, "Longest wait for running requests after SIGTERM");
  settings.add("log-level", config.log_level, "Least severity that is logged")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}));

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    outcome.exit = true;
    outcome.status = app.exit(error) == 0 ? 0 : 2;
    if (outcome.status != 0) name_environment_twins(app);
  }
  if (config.slots == 0) config.slots = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return outcome;
}

}  // namespace papilio::server
