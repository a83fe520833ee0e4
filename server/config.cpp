#include "server/config.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>

#include "server/address_space.h"
#include "server/container_limits.h"
#include "server/page.h"

namespace papilio::server {
namespace {

std::string environment_twin(std::string flag) {
  std::ranges::replace(flag, '-', '_');
  std::ranges::transform(flag, flag.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return "PAPILIO_" + flag;
}

/// Prints the settings that came from the environment, after a refusal, which names only flags.
void name_environment_twins(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const char* value = option->get_envname().empty() ? nullptr : std::getenv(option->get_envname().c_str());
    if (value == nullptr) continue;
    const bool may_hold_password = option->check_lname("store");
    std::cerr << "The environment has " << option->get_envname() << (may_hold_password ? "" : "=")
              << (may_hold_password ? "" : value) << '\n';
  }
}

/// Throws CLI::ParseError for an invalid value in the environment, which CLI11 ignores from version 2.4 on.
void refuse_wrong_environment(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const char* value = option->get_envname().empty() ? nullptr : std::getenv(option->get_envname().c_str());
    if (value == nullptr || *value == '\0' || option->count() > 0) continue;
    option->add_result(value);
    option->run_callback();
  }
}

/// Builder of the settings, one call each; the environment variable is derived from the flag.
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
  void add_flag(const std::string& flag, bool& value, const std::string& description) {
    app_.add_flag("--" + flag, value, description)->envname(environment_twin(flag));
  }

 private:
  CLI::App& app_;
};

constexpr uint64_t most_bytes = 4ULL << 30;
constexpr uint64_t most_kept = 1ULL << 44;
constexpr uint64_t most_faces = 1ULL << 30;

void add_http_settings(Settings& settings, HttpOptions& http) {
  settings.add("host", http.host, "Address to listen on; 0.0.0.0: all interfaces");
  settings.add("port", http.port, 0, 65535, "Port to listen on; 0: a free port");
  CLI::Option* const certificate = settings.add(
      "tls-cert", http.tls_cert, "PEM file of the certificate and its intermediates; enables HTTPS and disables HTTP");
  settings.add("tls-key", http.tls_key, "PEM file of the certificate's key, without a passphrase")
      ->needs(certificate->check(CLI::ExistingFile))
      ->check(CLI::ExistingFile);
  certificate->needs("--tls-key");
  settings.add("max-body-bytes", http.max_body_bytes, uint64_t{1}, most_bytes, "Largest request body; above: 413");
  settings.add(
      "max-held-bytes", http.max_held_bytes, uint64_t{1}, most_kept,
      "Limit of all request bodies in memory; above: 429. Also of all unsent answers; above: the oldest are cut");
  settings.add("max-header-bytes", http.max_header_bytes, uint64_t{1024}, uint64_t{1} << 20,
               "Largest request line and header fields together; above: 431");
  settings.add("connections", http.threads, 1, 10000,
               "Requests served at once, each on a thread; idle connections hold no thread");
  settings.add("idle-seconds", http.idle_seconds, 1, 3600, "Idle time after which a connection is closed");
  settings.add("read-seconds", http.read_seconds, 1, 3600, "Longest wait for the next bytes of a request");
  settings.add("write-seconds", http.write_seconds, 1, 3600, "Longest wait for a client to receive the next byte");
}

void add_limits(Settings& settings, Config& config) {
  proto::Limits& limits = config.engine.limits;
  settings.add("max-input-faces", limits.max_input_faces, uint64_t{1}, most_faces,
               "Most faces of an input mesh; above: 413");
  settings.add("max-input-vertices", limits.max_input_vertices, uint64_t{1}, most_faces,
               "Most vertices of an input mesh; above: 413");
  settings.add("max-output-faces", limits.max_output_faces, uint64_t{1}, most_faces,
               "Most faces of a result; above: 507");
  settings.add("max-compute-seconds", limits.max_compute_seconds, 0, 86400,
               "Longest time of a refinement; above: 507; 0: no limit");
  settings.add("max-compute-bytes", limits.max_compute_bytes, uint64_t{0}, most_kept,
               "Most memory of a refinement and its encoding; above: 507; 0: no limit");
  settings.add("max-memory-bytes", config.max_memory_bytes, uint64_t{0}, most_kept,
               "Limit of the process's address space; 0: computed from the other settings");
  settings.add("slots", config.engine.slots, 0, 1024,
               "Requests computed at once, plus one small request; 0: one per core of the container");
  settings.add("queue", config.engine.queue, 0, 100000,
               "Requests that may wait for a slot, at most half of them large; above: 429");
  settings.add("drain-seconds", config.drain_seconds, 0, 3600, "Longest wait for running requests after SIGTERM");
}

void add_store_settings(Settings& settings, EngineOptions& engine) {
  settings.add("store", engine.store.address,
               "Store of meshes: memory, directory:PATH, redis://[USER:PASSWORD@]HOST[:PORT][/DATABASE] (USER "
               "and PASSWORD percent-encoded) or redis+unix:PATH");
  settings.add("store-bytes", engine.store.bytes, uint64_t{1024}, most_kept,
               "Size of the store; above: in memory, least recently used meshes are evicted; otherwise 507");
  settings.add("store-seconds", engine.store.seconds, 0, 1 << 30,
               "Redis: time after which unused meshes expire; 0: never");
  settings.add("result-cache-bytes", engine.result_cache_bytes, uint64_t{0}, most_kept,
               "Cache of results of stored meshes; 0: no cache");
  settings.add("mesh-cache-bytes", engine.mesh_cache_bytes, uint64_t{0}, most_kept,
               "Cache of stored meshes prepared for new views; 0: no cache");
  settings.add("cache-seconds", engine.cache_seconds, 0, 31536000, "Cache-Control max-age of results");
}

void add_page_settings(Settings& settings, EngineOptions& engine) {
  settings.add("web", engine.web, "Folder of the viewer, served at /; \"\": no viewer")
      ->default_str("beside the program");
  settings.add("samples", engine.samples, "Folder of .drc meshes offered by the viewer, besides a mug and a wheel");
}

void add_access_settings(Settings& settings, Config& config) {
  settings.add("keys", config.keys, "File of keys, with `NAME KEY` or `NAME KEY manage` per line; SIGHUP rereads it");
  settings.add_flag("allow-open", config.allow_open, "Allow an address beyond loopback without keys");
  settings
      .add("trusted-proxies", config.http.trusted_proxies,
           "Addresses of proxies, as in the log's remote=, whose X-Forwarded-For names the client")
      ->delimiter(',');
  settings.add("cors-origins", config.cors_origins, "Origins of pages that may use the service, or *")->delimiter(',');
}

void add_log_settings(Settings& settings, Config& config) {
  settings.add("log-level", config.log_level, "Lowest logged severity")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}));
  const std::map<std::string, LogFormat> formats{{"text", LogFormat::text}, {"json", LogFormat::json}};
  settings.add("log-format", config.log_format, "Format of the log: text (key=value) or json")
      ->default_str("text")
      ->transform(CLI::CheckedTransformer(formats).description("{text,json}"));
}

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" ||
         (host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos);
}

/// Throws CLI::ValidationError for settings that contradict each other.
void check_together(const Config& config) {
  if (config.keys.empty() && !config.allow_open && !is_loopback(config.http.host))
    throw CLI::ValidationError("--host", config.http.host +
                                             " is reachable by others, and no keys are required. Give --keys FILE, or "
                                             "--allow-open if this is intended.");
  if (config.http.max_held_bytes < config.http.max_body_bytes)
    throw CLI::ValidationError("--max-held-bytes", "is " + std::to_string(config.http.max_held_bytes) +
                                                       ", less than --max-body-bytes, which is " +
                                                       std::to_string(config.http.max_body_bytes) +
                                                       ": the largest body could not be held.");
  const uint64_t least = address_space_of_threads(config);
  if (config.max_memory_bytes > 0 && config.max_memory_bytes < least)
    throw CLI::ValidationError("--max-memory-bytes", "must be at least " + std::to_string(least) +
                                                         " for the stacks of these --connections and --slots, or 0.");
}

}  // namespace

ConfigOutcome parse_config(int argc, const char* const* argv) {
  ConfigOutcome outcome;
  Config& config = outcome.config;
  config.engine.web = default_page_folder();
  config.engine.limits.max_compute_seconds = 60;
  config.engine.limits.max_compute_bytes = 2ULL << 30;
  CLI::App app{"papilio-server: refines Draco meshes over HTTP where they are curved, visible and large on screen."};
  app.footer(
      "It prints `listening on http://HOST:PORT` (https:// with TLS) on standard output and logs to standard error.\n"
      "SIGTERM or SIGINT lets running requests finish, then ends with status 0; SIGHUP reads keys and\ncertificate "
      "again.");
  app.set_version_flag("--version", "papilio-server " PAPILIO_VERSION);
  app.option_defaults()->always_capture_default();

  Settings settings(app);
  add_http_settings(settings, config.http);
  add_limits(settings, config);
  add_store_settings(settings, config.engine);
  add_page_settings(settings, config.engine);
  add_access_settings(settings, config);
  add_log_settings(settings, config);

  try {
    app.parse(argc, argv);
    refuse_wrong_environment(app);
    const ContainerLimits container = container_limits();
    config.container_memory_bytes = container.memory_bytes.value_or(0);
    if (config.engine.slots == 0) config.engine.slots = usable_cores(container);
    check_together(config);
  } catch (const CLI::ParseError& error) {
    outcome.exit = true;
    outcome.status = app.exit(error) == 0 ? 0 : 2;
    if (outcome.status != 0) name_environment_twins(app);
  }
  config.engine.max_body_bytes = config.http.max_body_bytes;
  config.engine.keyed = !config.keys.empty();
  return outcome;
}

}  // namespace papilio::server
