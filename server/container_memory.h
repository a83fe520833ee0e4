#pragma once

#include <cstdint>

namespace papilio::server {

/// Limits the writable memory of this process (RLIMIT_DATA) to the container's memory less a sixteenth, which the
/// kernel uses on its behalf. A mesh that is too large then fails alone (std::bad_alloc) before the container is
/// killed. Has no effect under a sanitizer. Throws std::runtime_error if the limit cannot be applied.
void bound_by_container(uint64_t container_bytes);

/// Stack of a thread, which counts as writable memory although little of it is used. While this exists, the limit, if
/// any, is raised by it.
class StackSpace {
 public:
  StackSpace();
  ~StackSpace();
  StackSpace(const StackSpace&) = delete;
  StackSpace& operator=(const StackSpace&) = delete;
};

}  // namespace papilio::server
