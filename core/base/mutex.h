#pragma once

// WebAssembly's standard library has no threads: its locks do nothing.

#if defined(__wasm__)
namespace papilio {

struct Mutex {};

class [[nodiscard]] Lock {
 public:
  explicit Lock(Mutex& /*mutex*/) {}
};

}  // namespace papilio
#else
#include <mutex>

namespace papilio {

using Mutex = std::mutex;
using Lock = std::scoped_lock<std::mutex>;

}  // namespace papilio
#endif
