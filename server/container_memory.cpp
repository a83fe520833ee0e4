#include "server/container_memory.h"

#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>

#include "server/address_space.h"

namespace papilio::server {
namespace {

std::mutex mutex;
uint64_t bound = 0;        ///< limit without stacks, guarded by mutex; 0: no limit
uint64_t stack_count = 0;  ///< number of stacks, guarded by mutex

/// Applies the limit, with the mutex held.
bool apply() {
  rlimit limit{};
  ::getrlimit(RLIMIT_DATA, &limit);
  const uint64_t bytes = bound + stack_count * stack_bytes;
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY ? bytes : std::min<rlim_t>(bytes, limit.rlim_max);
  return ::setrlimit(RLIMIT_DATA, &limit) == 0;
}

}  // namespace

void bound_by_container(uint64_t container_bytes) {
  if (is_sanitized) return;
  const std::lock_guard lock(mutex);
  bound = container_bytes - container_bytes / 16;
  if (!apply())
    throw std::runtime_error(std::string("the container's memory cannot be a bound: ") + std::strerror(errno));
}

StackSpace::StackSpace() {
  const std::lock_guard lock(mutex);
  ++stack_count;
  if (bound > 0) apply();
}

StackSpace::~StackSpace() {
  const std::lock_guard lock(mutex);
  --stack_count;
  if (bound > 0) apply();
}

}  // namespace papilio::server
