#pragma once

#include <new>

#include "papilio/error.h"
#include "proto/problem.h"

namespace papilio::proto {

/// Runs `work`. Throws errors of the core, and a lack of memory, as `Problem`.
template <class Work>
auto translate_errors(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Problem(error);
  } catch (const std::bad_alloc&) {
    throw Problem(Code::result_too_large, "Not enough memory for the result. Request fewer levels.");
  }
}

}  // namespace papilio::proto
