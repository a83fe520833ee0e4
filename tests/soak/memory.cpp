#include "tests/soak/memory.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <thread>

namespace papilio::soak {
namespace {

constexpr auto settling = std::chrono::seconds(
    12);  // idle connections close after 5 s and their threads after 6 s; memory is released within another 5 s
constexpr int samples = 5;
constexpr ptrdiff_t looks = 3;

double mean(std::vector<double>::const_iterator first, std::vector<double>::const_iterator last) {
  return std::accumulate(first, last, 0.0) / static_cast<double>(last - first);
}

}  // namespace

double Memory::resident() const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  double kibibytes = 0;
  for (std::string word; status >> word;)
    if (word == "VmRSS:") status >> kibibytes;
  return kibibytes / 1024;
}

void Memory::look(bool warm) {
  std::this_thread::sleep_for(settling);
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    sum += resident();
  }
  (warm ? warm_ : warm_up_).push_back(sum / samples);
}

double Memory::at_start() const { return warm_.size() < 2 * looks ? 0 : mean(warm_.begin(), warm_.begin() + looks); }

double Memory::at_end() const { return warm_.size() < 2 * looks ? 0 : mean(warm_.end() - looks, warm_.end()); }

void Memory::print() const {
  std::printf("\nresident memory at rest, MiB: warming up");
  for (const double value : warm_up_) std::printf(" %.1f", value);
  std::printf("; then");
  for (const double value : warm_) std::printf(" %.1f", value);
  if (at_start() > 0)
    std::printf("\nmemory: %.1f MiB after the warm-up, %.1f MiB at the end: %+.2f %%\n", at_start(), at_end(),
                100 * growth());
  else
    std::printf("\nmemory: too few looks after the warm-up to say how it grows\n");
}

}  // namespace papilio::soak
