#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "proto/gltf/scene_refinement.h"
#include "proto/multipart.h"
#include "proto/parameters.h"
#include "proto/refinement.h"

namespace papilio::client {

/// Failure of a server: `what()` has its message, or the reason why it could not be reached.
class ServerError : public std::runtime_error {
 public:
  ServerError(int status, std::string code, const std::string& what)
      : std::runtime_error(what), status_(status), code_(std::move(code)) {}
  [[nodiscard]] int status() const { return status_; }             ///< HTTP status; 0 without an answer
  [[nodiscard]] const std::string& code() const { return code_; }  ///< public code of the problem, "" if unknown

 private:
  int status_;
  std::string code_;
};

/// Options of the connection to a server.
struct RemoteOptions {
  std::string ca_file{};  ///< PEM file of trusted certificates over HTTPS; "": the system's
  std::string key{};      ///< access key, sent as `Authorization: Bearer`; "": none
};

/// Health check of a server.
enum class Health {
  alive,  ///< GET /health: whether the server runs
  ready,  ///< GET /ready: whether it accepts work now
};

/// Papilio server. Not thread-safe.
class Remote {
 public:
  /// Refers to the server at `url`: "http://host:port" or "https://…", optionally with a path before /v1. Over HTTPS
  /// the server's certificate must match its host, and be signed by a trusted one. Throws std::invalid_argument for an
  /// invalid URL.
  explicit Remote(const std::string& url, RemoteOptions options = {});

  /// Refines a Draco mesh, or a packed model as a mesh, at the server. Bytes are identical to those of a local
  /// `proto::Refinement`. Repeats the request to a busy server up to 30 times, after the pauses that it states. Throws
  /// `ServerError`.
  [[nodiscard]] proto::EncodedLevel refine(std::string_view bytes, const proto::Parameters& parameters) const;

  /// Refines a scene, a .glb file, at the server. Bytes are identical to those of a local
  /// `proto::gltf::SceneRefinement`. Repeats the request to a busy server, as refine(). Throws `ServerError`.
  [[nodiscard]] proto::EncodedLevel refine_scene(std::string_view glb, const proto::Parameters& parameters) const;

  /// Refines a Draco mesh level by level: calls `on_part` for each part as it arrives, the meshes first, then the JSON
  /// summary. Throws `ServerError`, also for a problem received as a part.
  void refine_levels(std::string_view draco, const proto::Parameters& parameters,
                     const std::function<void(const proto::BodyPart&)>& on_part) const;

  /// Returns the server's positive answer, "alive" or "ready", within seconds. Throws `ServerError` for another answer,
  /// or none.
  [[nodiscard]] std::string health(Health question) const;

 private:
  std::string origin_;  ///< "http://host:port"
  std::string prefix_;  ///< path without a trailing slash
  RemoteOptions options_;
};

}  // namespace papilio::client
