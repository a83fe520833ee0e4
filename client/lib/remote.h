#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "proto/gltf/scene_refinement.h"
#include "proto/multipart.h"
#include "proto/parameters.h"
#include "proto/refinement.h"

namespace papilio::client {

/// A server did not do what was asked: `what()` has its words, or why it could not be reached.
class ServerError : public std::runtime_error {
 public:
  ServerError(int status, std::string code, const std::string& what)
      : std::runtime_error(what), status_(status), code_(std::move(code)) {}
  [[nodiscard]] int status() const { return status_; }             ///< HTTP status; 0 when there was no answer
  [[nodiscard]] const std::string& code() const { return code_; }  ///< public code of the problem, "" when unknown

 private:
  int status_;
  std::string code_;
};

/// How a server is spoken to.
struct RemoteOptions {
  std::string ca_file{};  ///< PEM file of the certificates to trust over HTTPS; "": the system's
  std::string key{};      ///< sent as `Authorization: Bearer`; "": none
};

/// What can be asked of a server besides work.
enum class Health {
  alive,  ///< GET /health: never waits on work
  ready,  ///< GET /ready: takes work now
};

/// A Papilio server. One object may be used by one thread at a time.
class Remote {
 public:
  /// `url`: "http://host:port" or "https://…", optionally with a path in front of /v1. Over HTTPS the server's
  /// certificate must be of its host's name, and signed by one that is trusted. Throws std::invalid_argument when it is
  /// not a URL.
  explicit Remote(const std::string& url, RemoteOptions options = {});

  /// Refines a Draco mesh, or a packed model as a mesh, there; the same bytes as `proto::Refinement` makes here. A busy
  /// server is asked again, up to 30 times, after the pauses that it names. Throws `ServerError`.
  [[nodiscard]] proto::EncodedLevel refine(std::string_view bytes, const proto::Parameters& parameters) const;

  /// Refines a scene there, a .glb file; the same bytes as `proto::gltf::SceneRefinement` makes here. Asks a busy
  /// server again, as `refine`. Throws `ServerError`.
  [[nodiscard]] proto::EncodedLevel refine_scene(std::string_view glb, const proto::Parameters& parameters) const;

  /// The same level by level: `on_part` is called for each part as it arrives, meshes first, the JSON summary
  /// last. Throws `ServerError`, also for a problem that comes in the middle.
  void refine_levels(std::string_view draco, const proto::Parameters& parameters,
                     const std::function<void(const proto::Part&)>& on_part) const;

  /// The server's word for yes, "alive" or "ready", within seconds. Throws `ServerError` where the answer is another or
  /// does not come.
  [[nodiscard]] std::string health(Health question) const;

 private:
  std::string origin_;  ///< "http://host:port"
  std::string prefix_;  ///< path without a slash at its end
  RemoteOptions options_;
};

}  // namespace papilio::client
