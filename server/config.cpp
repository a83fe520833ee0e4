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

/// After a refusal: which settings came from the environment, since the refusal names flags only.
void name_environment_twins(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const char* value = option->get_envname().empty() ? nullptr : std::getenv(option->get_envname().c_str());
    if (value == nullptr) continue;
    const bool may_hold_password = option->check_lname("store");
    std::cerr << "The environment has " << option->get_envname() << (may_hold_password ? "" : "=")
              << (may_hold_password ? "" : value) << '\n';
  }
}

/// What CLI11 from 2.4 on passes over in silence: values of the environment that are not right. Throws CLI::ParseError.
void refuse_wrong_environment(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const char* value = option->get_envname().empty() ? nullptr : std::getenv(option->get_envname().c_str());
    if (value == nullptr || *value == '\0' || option->count() > 0) continue;
    option->add_result(value);
    option->run_callback();
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
  settings.add("host", http.host, "Address to listen on; 0.0.0.0 for all");
  settings.add("port", http.port, 0, 65535, "Port to listen on; 0 picks a free one");
  CLI::Option* const certificate =
      settings.add("tls-cert", http.tls_cert, "PEM file of a certificate and its intermediates: HTTPS only");
  settings.add("tls-key", http.tls_key, "PEM file of its key, without a passphrase")
      ->needs(certificate->check(CLI::ExistingFile))
      ->check(CLI::ExistingFile);
  certificate->needs("--tls-key");
  settings.add("max-body-bytes", http.max_body_bytes, uint64_t{1}, most_bytes, "Largest request body: 413");
  settings.add(
      "max-held-bytes", http.max_held_bytes, uint64_t{1}, most_kept,
      "Most bytes of all bodies that are held at once: 429; as many of answers that are sent, the oldest are cut");
  settings.add("max-header-bytes", http.max_header_bytes, uint64_t{1024}, uint64_t{1} << 20,
               "Longest request line and header fields together: 431");
  settings.add("connections", http.threads, 1, 10000,
               "Requests served at once, each on a thread; silent connections take none");
  settings.add("idle-seconds", http.idle_seconds, 1, 3600, "A silent connection is closed after this");
  settings.add("read-seconds", http.read_seconds, 1, 3600, "Longest wait for the next bytes of a request");
  settings.add("write-seconds", http.write_seconds, 1, 3600, "Longest wait for a client to take any further byte");
}

void add_limits(Settings& settings, Config& config) {
  proto::Limits& limits = config.engine.limits;
  settings.add("max-input-faces", limits.max_input_faces, uint64_t{1}, most_faces, "Most faces of a mesh sent: 413");
  settings.add("max-input-vertices", limits.max_input_vertices, uint64_t{1}, most_faces,
               "Most vertices of a mesh sent: 413");
  settings.add("max-output-faces", limits.max_output_faces, uint64_t{1}, most_faces, "Most faces of a result: 507");
  settings.add("max-compute-seconds", limits.max_compute_seconds, 0, 86400,
               "Longest time of a refinement: 507; 0: no limit");
  settings.add("max-compute-bytes", limits.max_compute_bytes, uint64_t{0}, most_kept,
               "Most memory of a refinement and of its encoding: 507; 0: no limit");
  settings.add("max-memory-bytes", config.max_memory_bytes, uint64_t{0}, most_kept,
               "Address space of the process; 0: what the other settings may need");
  settings.add("slots", config.engine.slots, 0, 1024,
               "Requests computed at once, besides one small one; 0: one a core that the container has");
  settings.add("queue", config.engine.queue, 0, 100000,
               "Requests that may wait for a slot, half of them large ones; more are refused with 429");
  settings.add("drain-seconds", config.drain_seconds, 0, 3600, "Longest wait for running requests after SIGTERM");
}

void add_store_settings(Settings& settings, EngineOptions& engine) {
  settings.add("store", engine.store.address,
               "Where meshes are stored: memory, directory:PATH, redis://[USER:PASSWORD@]HOST[:PORT][/DATABASE] (USER "
               "and PASSWORD percent-encoded) or redis+unix:PATH");
  settings.add("store-bytes", engine.store.bytes, uint64_t{1024}, most_kept,
               "Size of the store; in memory the meshes used longest ago give way, elsewhere more are refused: 507");
  settings.add("store-seconds", engine.store.seconds, 0, 1 << 30,
               "Redis: meshes that are not used for so long go; 0: never");
  settings.add("result-cache-bytes", engine.result_cache_bytes, uint64_t{0}, most_kept,
               "Memory for results of stored meshes; 0: none are kept");
  settings.add("mesh-cache-bytes", engine.mesh_cache_bytes, uint64_t{0}, most_kept,
               "Memory for stored meshes made ready for new views; 0: none are kept");
  settings.add("cache-seconds", engine.cache_seconds, 0, 31536000, "How long others may cache a result");
}

void add_page_settings(Settings& settings, EngineOptions& engine) {
  settings.add("web", engine.web, "Folder of the viewer, which / answers; \"\": none")
      ->default_str("found beside the program");
  settings.add("samples", engine.samples, "Folder of .drc meshes that the viewer offers, besides a mug and a wheel");
}

void add_access_settings(Settings& settings, Config& config) {
  settings.add("keys", config.keys, "File of keys, `NAME KEY` or `NAME KEY manage` a line; SIGHUP reads it again");
  settings.add_flag("allow-open", config.allow_open, "Listen beyond loopback without keys");
  settings
      .add("trusted-proxies", config.http.trusted_proxies,
           "Addresses of proxies, as the log's remote= has them, whose X-Forwarded-For says which client is asking")
      ->delimiter(',');
  settings.add("cors-origins", config.cors_origins, "Origins whose pages may use the service, or *")->delimiter(',');
}

void add_log_settings(Settings& settings, Config& config) {
  settings.add("log-level", config.log_level, "Least severity that is logged")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}));
  const std::map<std::string, LogFormat> formats{{"text", LogFormat::text}, {"json", LogFormat::json}};
  settings.add("log-format", config.log_format, "text (key=value) or json")
      ->default_str("text")
      ->transform(CLI::CheckedTransformer(formats).description("{text,json}"));
}

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" ||
         (host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos);
}

/// What single settings cannot say. Throws CLI::ValidationError.
void check_together(const Config& config) {
  if (config.keys.empty() && !config.allow_open && !is_loopback(config.http.host))
    throw CLI::ValidationError("--host",
                               config.http.host +
                                   " can be reached by others, and no keys are asked for. Give --keys FILE, or "
                                   "--allow-open if that is meant.");
  if (config.http.max_held_bytes < config.http.max_body_bytes)
    throw CLI::ValidationError("--max-held-bytes", "is " + std::to_string(config.http.max_held_bytes) +
                                                       ", less than --max-body-bytes, which is " +
                                                       std::to_string(config.http.max_body_bytes) +
                                                       ": such a body could never be read.");
  const uint64_t least = address_space_of_threads(config);
  if (config.max_memory_bytes > 0 && config.max_memory_bytes < least)
    throw CLI::ValidationError("--max-memory-bytes", "must be at least " + std::to_string(least) +
                                                         " for the stacks of so many --connections and --slots; or 0.");
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
