#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace papilio::server {

/// What the container that this process is in leaves it.
struct ContainerLimits {
  std::optional<double> cores;           ///< seconds of processor time a second; nothing: no limit
  std::optional<uint64_t> memory_bytes;  ///< nothing: no limit
};

/// Reads the limits of the process's control groups, of version 1 or 2, and of those above them. `groups`: where they
/// are mounted; `membership`: the file that says which ones the process is in. What cannot be read is no limit.
[[nodiscard]] ContainerLimits container_limits(const std::filesystem::path& groups = "/sys/fs/cgroup",
                                               const std::filesystem::path& membership = "/proc/self/cgroup");

/// The cores that threads of this process can keep busy: those it may run on, and no more than the container's limit,
/// rounded up. At least 1.
[[nodiscard]] int usable_cores(const ContainerLimits& limits);

}  // namespace papilio::server
