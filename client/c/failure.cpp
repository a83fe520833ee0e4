#include "client/c/failure.h"

namespace papilio::c {
namespace {

papilio_fault fault_of(proto::Code code) {
  switch (code) {
    case proto::Code::bad_parameter:
    case proto::Code::unknown_parameter:
    case proto::Code::bad_request:
      return PAPILIO_BAD_PARAMETER;
    case proto::Code::mesh_unusable:
      return PAPILIO_UNUSABLE_MESH;
    case proto::Code::result_too_large:
      return PAPILIO_TOO_LARGE;
    case proto::Code::cancelled:
      return PAPILIO_CANCELLED;
    default:
      return PAPILIO_INTERNAL;
  }
}

}  // namespace

Failure failure_of(const proto::Problem& problem) {
  return {fault_of(problem.code()), problem.what(), problem.parameter()};
}

Failure failure_of(const Error& error) {
  Failure failure = failure_of(proto::Problem(error));
  if (error.fault() == Fault::out_of_memory) failure.fault = PAPILIO_OUT_OF_MEMORY;
  return failure;
}

Failure failure_of(const std::exception& error) { return {PAPILIO_INTERNAL, error.what()}; }

Failure lack_of_memory() {
  return {PAPILIO_OUT_OF_MEMORY, "There is not enough memory for this result. Ask for fewer levels."};
}

}  // namespace papilio::c
