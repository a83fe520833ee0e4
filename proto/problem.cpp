#include "proto/problem.h"

#include <array>
#include <nlohmann/json.hpp>

namespace papilio::proto {
namespace {

constexpr std::array kinds{
    ProblemKind{Code::bad_parameter, "bad_parameter", 400, "Invalid value of a parameter"},
    ProblemKind{Code::unknown_parameter, "unknown_parameter", 400, "Unknown parameter"},
    ProblemKind{Code::bad_request, "bad_request", 400, "Malformed request"},
    ProblemKind{Code::unauthorized, "unauthorized", 401, "An access key is required"},
    ProblemKind{Code::forbidden, "forbidden", 403, "The access key lacks the required right"},
    ProblemKind{Code::not_found, "not_found", 404, "Unknown path"},
    ProblemKind{Code::mesh_not_found, "mesh_not_found", 404, "Unknown mesh"},
    ProblemKind{Code::method_not_allowed, "method_not_allowed", 405, "The path does not support this method"},
    ProblemKind{Code::not_acceptable, "not_acceptable", 406, "No acceptable format of the response"},
    ProblemKind{Code::request_timeout, "request_timeout", 408, "The request did not arrive in time"},
    ProblemKind{Code::length_required, "length_required", 411, "Content-Length is required"},
    ProblemKind{Code::body_too_large, "body_too_large", 413, "The body is too large"},
    ProblemKind{Code::mesh_too_large, "mesh_too_large", 413, "The mesh is too large"},
    ProblemKind{Code::unsupported_media_type, "unsupported_media_type", 415, "Unsupported Content-Type"},
    ProblemKind{Code::unsupported_encoding, "unsupported_encoding", 415, "Unsupported Content-Encoding"},
    ProblemKind{Code::range_not_supported, "range_not_supported", 416, "Range requests are not supported"},
    ProblemKind{Code::headers_too_large, "headers_too_large", 431, "The request header is too large"},
    ProblemKind{Code::mesh_not_draco, "mesh_not_draco", 422, "The mesh is not a valid Draco stream"},
    ProblemKind{Code::mesh_not_gltf, "mesh_not_gltf", 422, "The scene is not valid glTF"},
    ProblemKind{Code::mesh_unsupported, "mesh_unsupported", 422, "Unsupported kind of mesh"},
    ProblemKind{Code::mesh_unusable, "mesh_unusable", 422, "The mesh cannot be refined"},
    ProblemKind{Code::busy, "busy", 429, "All computing slots are taken"},
    ProblemKind{Code::not_ready, "not_ready", 503, "The server accepts no further requests at present"},
    ProblemKind{Code::draining, "draining", 503, "The server is shutting down"},
    ProblemKind{Code::store_unavailable, "store_unavailable", 503, "The mesh store is unavailable"},
    ProblemKind{Code::out_of_memory, "out_of_memory", 503, "Not enough memory at present"},
    ProblemKind{Code::result_too_large, "result_too_large", 507, "The result would exceed a limit"},
    ProblemKind{Code::takes_too_long, "takes_too_long", 507, "The computation exceeds the time limit"},
    ProblemKind{Code::store_full, "store_full", 507, "The mesh store is full"},
    ProblemKind{Code::cancelled, "cancelled", 499, "The client closed the request"},
    ProblemKind{Code::internal, "internal", 500, "Internal server error"},
};

Code code_of(Fault fault) {
  switch (fault) {
    case Fault::index_out_of_range:
    case Fault::not_finite:
    case Fault::no_faces:
    case Fault::bad_surface:
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
