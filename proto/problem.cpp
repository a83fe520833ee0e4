#include "proto/problem.h"

#include <array>
#include <nlohmann/json.hpp>

namespace papilio::proto {
namespace {

constexpr std::array kinds{
    ProblemKind{Code::bad_parameter, "bad_parameter", 400, "A parameter has a value it cannot take"},
    ProblemKind{Code::unknown_parameter, "unknown_parameter", 400, "There is no such parameter"},
    ProblemKind{Code::bad_request, "bad_request", 400, "The request cannot be read"},
    ProblemKind{Code::unauthorized, "unauthorized", 401, "A key is needed"},
    ProblemKind{Code::forbidden, "forbidden", 403, "This key may not do this"},
    ProblemKind{Code::not_found, "not_found", 404, "There is nothing at this path"},
    ProblemKind{Code::mesh_not_found, "mesh_not_found", 404, "There is no such mesh"},
    ProblemKind{Code::method_not_allowed, "method_not_allowed", 405, "This path does not take this method"},
    ProblemKind{Code::not_acceptable, "not_acceptable", 406, "No acceptable form of the answer exists"},
    ProblemKind{Code::request_timeout, "request_timeout", 408, "The request did not arrive in time"},
    ProblemKind{Code::length_required, "length_required", 411, "The body's length is missing"},
    ProblemKind{Code::body_too_large, "body_too_large", 413, "The body is too large"},
    ProblemKind{Code::mesh_too_large, "mesh_too_large", 413, "The mesh is too large"},
    ProblemKind{Code::unsupported_media_type, "unsupported_media_type", 415, "The body's type is not read here"},
    ProblemKind{Code::unsupported_encoding, "unsupported_encoding", 415, "Encoded bodies are not read here"},
    ProblemKind{Code::range_not_supported, "range_not_supported", 416, "Answers are sent whole"},
    ProblemKind{Code::headers_too_large, "headers_too_large", 431, "The request's header is too large"},
    ProblemKind{Code::mesh_not_draco, "mesh_not_draco", 422, "The mesh is not a readable Draco stream"},
    ProblemKind{Code::mesh_unsupported, "mesh_unsupported", 422, "This kind of Draco stream is not read here"},
    ProblemKind{Code::mesh_unusable, "mesh_unusable", 422, "The mesh cannot be refined"},
    ProblemKind{Code::busy, "busy", 429, "Every computing slot is taken"},
    ProblemKind{Code::not_ready, "not_ready", 503, "No further request would be let in now"},
    ProblemKind{Code::draining, "draining", 503, "The server is shutting down"},
    ProblemKind{Code::store_unavailable, "store_unavailable", 503, "The store of meshes does not answer"},
    ProblemKind{Code::out_of_memory, "out_of_memory", 503, "There is no memory for this now"},
    ProblemKind{Code::result_too_large, "result_too_large", 507, "The result would pass a limit"},
    ProblemKind{Code::takes_too_long, "takes_too_long", 507, "The work takes too long"},
    ProblemKind{Code::store_full, "store_full", 507, "The store of meshes is full"},
    ProblemKind{Code::cancelled, "cancelled", 499, "The client went away"},
    ProblemKind{Code::internal, "internal", 500, "Something failed inside the server"},
};

Code code_of(Fault fault) {
  switch (fault) {
    case Fault::index_out_of_range:
    case Fault::not_finite:
    case Fault::no_faces:
      return Code::mesh_unusable;
    case Fault::bad_option:
      return Code::bad_parameter;
    case Fault::result_too_large:
    case Fault::out_of_memory:
      return Code::result_too_large;
    case Fault::cancelled:
      return Code::cancelled;
  }
  return Code::internal;
}

}  // namespace

std::span<const ProblemKind> problem_kinds() { return kinds; }

const ProblemKind& problem_kind(Code code) { return kinds[static_cast<size_t>(code)]; }

Problem::Problem(const Error& error) : Problem(code_of(error.fault()), error.what(), error.option()) {}

std::string Problem::json(std::string_view request_id) const {
  const ProblemKind& kind = problem_kind(code_);
  nlohmann::ordered_json document{{"type", "urn:papilio:problem:" + std::string(kind.name)},
                                  {"code", kind.name},
                                  {"title", kind.title},
                                  {"status", kind.status},
                                  {"detail", what()}};
  if (!parameter_.empty()) document["parameter"] = parameter_;
  if (!request_id.empty()) document["request_id"] = request_id;
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace papilio::proto
