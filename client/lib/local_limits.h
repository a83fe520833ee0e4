#pragma once

#include <filesystem>

#include "proto/limits.h"

namespace papilio::client {

/// Files that tell how much memory there is.
struct MemoryFiles {
  std::filesystem::path available = "/proc/meminfo";            ///< of the machine
  std::filesystem::path allowed = "/sys/fs/cgroup/memory.max";  ///< of this container
};

/// Returns the limits of local work of which `jobs` run at once: the core's limit on faces, and for each job its share
/// of three quarters of the memory that is free; the rest is for what is read and written. What needs more is refused,
/// or stops, before the machine runs out of memory. No limit on memory where the files say nothing.
[[nodiscard]] proto::Limits local_limits(int jobs, const MemoryFiles& files = {});

}  // namespace papilio::client
