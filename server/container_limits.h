#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace papilio::server {

/// Limits of the process's container.
struct ContainerLimits {
  std::optional<double> cores;           ///< processor seconds per second; nothing: no limit
  std::optional<uint64_t> memory_bytes;  ///< memory; nothing: no limit
};

/// Reads the limits of the process's control groups, version 1 or 2, and of their ancestors. `groups`: mount point of
/// control groups. `membership`: file of the process's groups. Unreadable limits count as no limit.
[[nodiscard]] ContainerLimits container_limits(const std::filesystem::path& groups = "/sys/fs/cgroup",
                                               const std::filesystem::path& membership = "/proc/self/cgroup");

/// Returns the number of cores that the process may use: its affinity, bounded by the container's limit, rounded up. At
/// least 1.
[[nodiscard]] int usable_cores(const ContainerLimits& limits);

}  // namespace papilio::server
