#include "client/lib/local_limits.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>

#include "client/lib/mesh_stream.h"

namespace papilio::client {
namespace {

constexpr uint64_t unknown = std::numeric_limits<uint64_t>::max();

/// Returns the bytes of a line such as "MemAvailable:   23456 kB".
uint64_t available_bytes(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string name, unit;
  for (uint64_t kibibytes = 0; in >> name >> kibibytes; std::getline(in, unit))
    if (name == "MemAvailable:") return kibibytes << 10U;
  return unknown;
}

/// Returns the number that the file holds; not that of "max".
uint64_t allowed_bytes(const std::filesystem::path& file) {
  std::ifstream in(file);
  uint64_t bytes = 0;
  return in >> bytes && bytes > 0 ? bytes : unknown;
}

}  // namespace

proto::Limits local_limits(int jobs, const MemoryFiles& files) {
  proto::Limits limits = own_limits;
  const uint64_t bytes = std::min(available_bytes(files.available), allowed_bytes(files.allowed));
  if (bytes != unknown) limits.max_compute_bytes = std::max<uint64_t>(bytes / 4 * 3 / static_cast<uint64_t>(jobs), 1);
  return limits;
}

}  // namespace papilio::client
