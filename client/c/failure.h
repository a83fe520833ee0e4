#pragma once

#include <exception>
#include <string>

#include "client/c/papilio.h"
#include "papilio/error.h"
#include "proto/problem.h"

namespace papilio::c {

/// Error in the terms of the C functions.
struct Failure {
  papilio_fault fault = PAPILIO_NO_FAULT;
  std::string message{}, parameter{};
};

[[nodiscard]] Failure failure_of(const proto::Problem& problem);
[[nodiscard]] Failure failure_of(const Error& error);
/// Returns the failure of any other exception.
[[nodiscard]] Failure failure_of(const std::exception& error);
[[nodiscard]] Failure lack_of_memory();

}  // namespace papilio::c
