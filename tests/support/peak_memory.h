#pragma once

#include <functional>

namespace papilio::test {

/// Returns what `work` returns in a child process. Throws std::runtime_error where the child fails.
[[nodiscard]] double in_child_process(const std::function<double()>& work);

/// Returns by how many MiB `work` raises the most resident memory of a child process, which keeps no spare blocks of
/// its parent's and has done `before`.
[[nodiscard]] double peak_memory_of(
    const std::function<void()>& work, const std::function<void()>& before = [] {});

}  // namespace papilio::test
