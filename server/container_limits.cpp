#include "server/container_limits.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace papilio::server {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t unlimited_bytes = 1ULL << 60;  ///< lower bound of the numbers that mean "no limit" in version 1

/// Returns the first words of a file, up to two; none if it cannot be read.
std::vector<std::string> words_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> words;
  for (std::string word; words.size() < 2 && in >> word;) words.push_back(word);
  return words;
}

std::optional<int64_t> number(std::string_view text) {
  int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value > 0 ? std::optional(value) : std::nullopt;
}

std::optional<double> share(const std::optional<int64_t>& quota, const std::optional<int64_t>& period) {
  return quota && period ? std::optional(static_cast<double>(*quota) / static_cast<double>(*period)) : std::nullopt;
}

std::optional<double> cores_of(const fs::path& group) {
  if (const auto words = words_of(group / "cpu.max"); words.size() == 2)
    return share(number(words[0]), number(words[1]));
  const auto quota = words_of(group / "cpu.cfs_quota_us"), period = words_of(group / "cpu.cfs_period_us");
  return quota.empty() || period.empty() ? std::nullopt : share(number(quota[0]), number(period[0]));
}

std::optional<uint64_t> memory_of(const fs::path& group) {
  for (const char* name : {"memory.max", "memory.limit_in_bytes"}) {
    const auto words = words_of(group / name);
    const std::optional<int64_t> bytes = words.empty() ? std::nullopt : number(words[0]);
    if (bytes && static_cast<uint64_t>(*bytes) < unlimited_bytes) return static_cast<uint64_t>(*bytes);
  }
  return std::nullopt;
}

template <class T>
void lower(std::optional<T>& least, const std::optional<T>& limit) {
  if (limit && (!least || *limit < *least)) least = limit;
}

}  // namespace

ContainerLimits container_limits(const fs::path& groups, const fs::path& membership) {
  ContainerLimits limits;
  std::ifstream in(membership);
  // A line is NUMBER:CONTROLLERS:PATH, without controllers in version 2. Inside a container, the path may be the host's
  // and not exist: its group is then the root of the mount.
  for (std::string line; std::getline(in, line);) {
    const size_t first = line.find(':');
    const size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const fs::path root = groups / line.substr(first + 1, second - first - 1);
    fs::path inner = fs::path(line.substr(second + 1)).relative_path().lexically_normal();
    while (true) {
      lower(limits.cores, cores_of(root / inner));
      lower(limits.memory_bytes, memory_of(root / inner));
      if (inner.empty() || inner == ".") break;
      inner = inner.parent_path();
    }
  }
  return limits;
}

int usable_cores(const ContainerLimits& limits) {
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return limits.cores ? std::clamp(static_cast<int>(std::ceil(*limits.cores)), 1, cores) : cores;
}

}  // namespace papilio::server
