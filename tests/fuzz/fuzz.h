#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "proto/problem.h"

// Shared by the targets. A finding aborts the program: a sanitizer report, an undocumented exception, or a failed
// `require`.

/// Entry point that libFuzzer calls with each input, and replay.cpp with each case.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace papilio::fuzz {

inline std::string_view text_of(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Splits the text at the first `separator`.
inline std::pair<std::string_view, std::string_view> cut(std::string_view text, char separator) {
  const size_t at = text.find(separator);
  if (at == std::string_view::npos) return {text, {}};
  return {text.substr(0, at), text.substr(at + 1)};
}

inline void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Runs work that may refuse its input with a `Problem` that can be sent. Returns whether the input was accepted.
template <class Work>
bool unless_refused(Work work) {
  try {
    work();
    return true;
  } catch (const proto::Problem& problem) {
    require(problem.code() != proto::Code::internal, "no refusal is a bug here");
    require(problem.json("fuzz").size() > 2, "a refusal can be written down");
  } catch (const Error& error) {
    require(*error.what() != '\0', "the core says why it refuses");
  }
  return false;
}

}  // namespace papilio::fuzz
