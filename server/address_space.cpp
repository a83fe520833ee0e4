#include "server/address_space.h"

#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "papilio/buffer.h"

namespace papilio::server {
namespace {

constexpr uint64_t arena_bytes = 128ULL << 20;  ///< mapping of glibc's malloc for each of 8 arenas per core
constexpr uint64_t base_bytes = 1ULL << 30;     ///< program and libraries
constexpr uint64_t least_base_bytes = 128ULL << 20;
/// Factor of a refinement's memory: as much again for decoding its mesh and for gaps in the heap.
constexpr uint64_t compute_shares = 2;
constexpr uint64_t unlimited_compute_bytes = 8ULL << 30;
constexpr uint64_t paused_bytes = 256ULL << 20;  ///< memory of a request after its time on the express slot

uint64_t stacks(const Config& config) {
  return (static_cast<uint64_t>(config.http.threads) + static_cast<uint64_t>(config.engine.slots)) * stack_bytes;
}

}  // namespace

uint64_t address_space_of_threads(const Config& config) { return least_base_bytes + stacks(config); }

uint64_t address_space_needed(const Config& config) {
  const EngineOptions& engine = config.engine;
  const uint64_t compute =
      engine.limits.max_compute_bytes > 0 ? engine.limits.max_compute_bytes : unlimited_compute_bytes;
  const auto slots = static_cast<uint64_t>(engine.slots) + 1;  // includes the express slot
  const auto paused = static_cast<uint64_t>(Admission::most_paused(engine.queue));
  const uint64_t store = engine.store.address == "memory" ? engine.store.bytes : 0;
  return base_bytes + stacks(config) + slots * (8 * arena_bytes + compute_shares * compute) + paused * paused_bytes +
         2 * config.http.max_held_bytes + store + engine.result_cache_bytes + engine.mesh_cache_bytes + spare_limit;
}

void limit_address_space(const Config& config) {
  if (is_sanitized) return;
  const uint64_t bytes = config.max_memory_bytes > 0 ? config.max_memory_bytes : address_space_needed(config);
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY ? bytes : std::min<rlim_t>(bytes, limit.rlim_max);
  if (::setrlimit(RLIMIT_AS, &limit) != 0)
    throw std::runtime_error(std::string("--max-memory-bytes: ") + std::strerror(errno));
}

}  // namespace papilio::server
