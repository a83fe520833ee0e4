#pragma once

#include <new>

#include "core/error.h"
#include "proto/problem.h"

namespace papilio::proto {

/// Runs `work` and puts the core's refusals, and memory that is not there, into the words of the wire.
template <class Work>
auto in_words_of_the_wire(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Problem(error);
  } catch (const std::bad_alloc&) {
    throw Problem(Code::result_too_large, "Not enough memory for the result. Request fewer levels.");
  }
}

}  // namespace papilio::proto
