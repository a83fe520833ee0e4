#pragma once

#include <cstdint>

namespace papilio::server {

/// Bounds what this process writes to (RLIMIT_DATA) by the memory of the container it is in, less a sixteenth for what
/// the kernel holds for it: a mesh too large for it then fails for itself (std::bad_alloc), before the container is
/// killed. Not under a sanitizer. Throws std::runtime_error when it cannot be applied.
void bound_by_container(uint64_t container_bytes);

/// The stack of a thread: space that counts as written to, though next to nothing of it is. The bound, where there is
/// one, is larger by it while this lives.
class StackSpace {
 public:
  StackSpace();
  ~StackSpace();
  StackSpace(const StackSpace&) = delete;
  StackSpace& operator=(const StackSpace&) = delete;
};

}  // namespace papilio::server
