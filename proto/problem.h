#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "papilio/error.h"

namespace papilio::proto {

/// Every error that the service answers with. The list is closed: a refusal that fits none of these gets a
/// row of its own in `problem_kinds()`, which gives its public code, HTTP status and title.
enum class Code {
  bad_parameter,           ///< a value that does not parse or is outside its range
  unknown_parameter,       ///< a name that no parameter has
  bad_request,             ///< the request itself cannot be read: form, JSON, framing
  unauthorized,            ///< a key is needed, and there was none or an unknown one
  forbidden,               ///< a known key without the right to do this
  not_found,               ///< no such path
  mesh_not_found,          ///< no mesh is stored under this id
  method_not_allowed,      ///< the path exists, the method does not
  not_acceptable,          ///< `Accept` names nothing that this path makes
  request_timeout,         ///< the body did not arrive in time
  length_required,         ///< a POST with neither Content-Length nor chunked encoding
  body_too_large,          ///< more bytes than the limit
  mesh_too_large,          ///< declared or decoded vertices or faces past the limit
  unsupported_media_type,  ///< a Content-Type that is not read here
  unsupported_encoding,    ///< a Content-Encoding: bodies are read as they are
  range_not_supported,     ///< a Range header: answers are sent whole
  headers_too_large,       ///< request line or header fields past the limit
  mesh_not_draco,          ///< not a Draco stream, or cut short, or damaged
  mesh_unsupported,        ///< Draco, but of a kind or version that is not read here
  mesh_unusable,           ///< decoded, but cannot be refined: nothing in it, NaN, bad indices
  busy,                    ///< every computing slot and waiting place is taken
  not_ready,               ///< /ready only: no further request would be let in now
  draining,                ///< the server is shutting down
  store_unavailable,       ///< the store of meshes does not answer
  out_of_memory,           ///< there is no memory for the request at present
  result_too_large,        ///< the result would pass the limit on faces or memory
  takes_too_long,          ///< the work passed the limit on computing time
  store_full,              ///< the store has no room for the mesh
  cancelled,               ///< the client went away; nobody reads this answer
  internal,                ///< a bug here
};

/// One row of the table of errors.
struct ProblemKind {
  Code code;
  std::string_view name;   ///< stable public code, as in `"code": "body_too_large"`
  int status;              ///< HTTP status
  std::string_view title;  ///< one line in plain words
};

/// All rows, in the order of `Code`.
[[nodiscard]] std::span<const ProblemKind> problem_kinds();
[[nodiscard]] const ProblemKind& problem_kind(Code code);

/// An error on its way to a user: thrown anywhere between the socket and the core, answered in one place.
class Problem : public std::runtime_error {
 public:
  /// `detail` says what is wrong here and what to do; `parameter` names the parameter at fault, if one is.
  Problem(Code code, const std::string& detail, std::string parameter = {})
      : std::runtime_error(detail), code_(code), parameter_(std::move(parameter)) {}
  /// The same refusal in the words of the wire.
  explicit Problem(const Error& error);

  [[nodiscard]] Code code() const { return code_; }
  [[nodiscard]] int status() const { return problem_kind(code_).status; }
  [[nodiscard]] const std::string& parameter() const { return parameter_; }
  /// RFC 9457 document (`application/problem+json`): type, code, title, status, detail, and parameter and
  /// request_id where they are known.
  [[nodiscard]] std::string json(std::string_view request_id) const;

 private:
  Code code_;
  std::string parameter_;
};

}  // namespace papilio::proto
