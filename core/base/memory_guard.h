#pragma once

#include <new>
#include <stdexcept>

#include "papilio/error.h"

namespace papilio {

/// Runs the work. Throws `Error` out_of_memory where memory is not there, or a length is more than there could be.
template <class Work>
auto guard_memory(const Work& work) {
  constexpr const char* words = "There is not enough memory for this result. Ask for fewer levels.";
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw Error(Fault::out_of_memory, words);
  } catch (const std::length_error&) {
    throw Error(Fault::out_of_memory, words);
  }
}

}  // namespace papilio
