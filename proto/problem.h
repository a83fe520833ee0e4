#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "papilio/error.h"

namespace papilio::proto {

/// Error of the service. The list is closed; `problem_kinds()` has the public code, HTTP status and title of each.
enum class Code {
  bad_parameter,           ///< a value that is malformed or out of range
  unknown_parameter,       ///< a name that no parameter has
  bad_request,             ///< a malformed request: form, JSON, framing
  unauthorized,            ///< no access key, or an unknown one
  forbidden,               ///< an access key without the required right
  not_found,               ///< no such path
  mesh_not_found,          ///< no mesh is stored under this id
  method_not_allowed,      ///< the path exists, the method does not
  not_acceptable,          ///< `Accept` has no format of this path
  request_timeout,         ///< the body did not arrive in time
  length_required,         ///< a POST with neither Content-Length nor chunked encoding
  body_too_large,          ///< more bytes than the limit
  mesh_too_large,          ///< declared or decoded vertices or faces past the limit
  unsupported_media_type,  ///< an unsupported Content-Type
  unsupported_encoding,    ///< any Content-Encoding
  range_not_supported,     ///< a Range header
  headers_too_large,       ///< request line or header fields past the limit
  mesh_not_draco,          ///< not a Draco stream, truncated or damaged
  mesh_not_gltf,           ///< neither a .glb file nor a glTF document, truncated or invalid
  mesh_unsupported,        ///< an unsupported kind or version of mesh
  mesh_unusable,           ///< a decoded mesh that cannot be refined: no faces, NaN, bad indices
  busy,                    ///< all computing slots and waiting places are taken
  not_ready,               ///< /ready only: no further request would be accepted
  draining,                ///< the server is shutting down
  store_unavailable,       ///< the mesh store is unavailable
  out_of_memory,           ///< not enough memory at present
  result_too_large,        ///< the result would exceed the limit on faces or memory
  takes_too_long,          ///< the computation exceeds the time limit
  store_full,              ///< the store has no room for the mesh
  cancelled,               ///< the client closed the request
  internal,                ///< a bug of the server
};

/// One row of the table of errors.
struct ProblemKind {
  Code code;
  std::string_view name;   ///< stable public code, as in `"code": "body_too_large"`
  int status;              ///< HTTP status
  std::string_view title;  ///< one line for users
};

/// Returns all rows in the order of `Code`.
[[nodiscard]] std::span<const ProblemKind> problem_kinds();
[[nodiscard]] const ProblemKind& problem_kind(Code code);

/// Error for the user, thrown anywhere between socket and core. One place converts it to a response.
class Problem : public std::runtime_error {
 public:
  /// `detail`: what is wrong and what to do. `parameter`: name of the invalid parameter, if any.
  Problem(Code code, const std::string& detail, std::string parameter = {})
      : std::runtime_error(detail), code_(code), parameter_(std::move(parameter)) {}
  /// Translates an error of the core.
  explicit Problem(const Error& error);

  [[nodiscard]] Code code() const { return code_; }
  [[nodiscard]] int status() const { return problem_kind(code_).status; }
  [[nodiscard]] const std::string& parameter() const { return parameter_; }
  /// Returns the RFC 9457 document (`application/problem+json`): type, code, title, status, detail, and parameter and
  /// request_id unless empty.
  [[nodiscard]] std::string json(std::string_view request_id) const;

 private:
  Code code_;
  std::string parameter_;
};

}  // namespace papilio::proto
