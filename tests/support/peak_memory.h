#pragma once

#include <functional>

namespace papilio::test {

/// Returns the result of `work` in a child process. Throws std::runtime_error if the child fails.
[[nodiscard]] double in_child_process(const std::function<double()>& work);

/// Returns the MiB by which `work` raises the peak resident memory of a child process after `before`. The child keeps
/// no spare blocks of its parent.
[[nodiscard]] double peak_memory_of(
    const std::function<void()>& work, const std::function<void()>& before = [] {});

}  // namespace papilio::test
