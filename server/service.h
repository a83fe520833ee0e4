#pragma once

#include "proto/limits.h"
#include "server/admission.h"
#include "server/http/http.h"

namespace papilio::server {

/// What the routes share. Threads may share it; it must outlive the server that it is added to.
class Service {
 public:
  Service(const proto::Limits& limits, uint64_t max_body_bytes, int slots, int queue);

  /// Adds POST /v1/refine, GET /v1/info, /health and /ready.
  void add_routes(HttpServer& server);

 private:
  [[nodiscard]] Response info() const;
  [[nodiscard]] Response ready() const;

  proto::Limits limits_;
  uint64_t max_body_bytes_;
  Admission admission_;
};

}  // namespace papilio::server
