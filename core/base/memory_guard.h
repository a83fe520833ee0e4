#pragma once

#include <new>
#include <stdexcept>

#include "papilio/error.h"

namespace papilio {

/// Runs the work. Throws `Error` out_of_memory, with the message, if an allocation fails or a length exceeds the
/// maximum.
template <class Work>
auto guard_memory(const Work& work,
                  const char* words = "There is not enough memory for this result. Ask for fewer levels.") {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw Error(Fault::out_of_memory, words);
  } catch (const std::length_error&) {
    throw Error(Fault::out_of_memory, words);
  }
}

}  // namespace papilio
