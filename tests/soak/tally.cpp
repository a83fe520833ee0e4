#include "tests/soak/tally.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace papilio::soak {
namespace {

constexpr size_t most_words = 20;

double percentile(const std::vector<float>& sorted, double share) {
  return sorted[std::min(sorted.size() - 1, static_cast<size_t>(share * static_cast<double>(sorted.size())))];
}

}  // namespace

void Tally::count(const std::string& kind, int status, const std::string& code) {
  const std::lock_guard lock(mutex_);
  ++(status < 400 ? rows_[kind].good : rows_[kind].refused);
  if (status >= 400) ++codes_[std::to_string(status) + " " + code];
}

void Tally::count_without_answer(const std::string& kind) {
  const std::lock_guard lock(mutex_);
  ++rows_[kind].without_answer;
}

void Tally::violate(const std::string& kind, const std::string& what) {
  const std::lock_guard lock(mutex_);
  ++rows_[kind].violations;
  if (words_.size() < most_words) words_.push_back(kind + ": " + what);
}

void Tally::time(double seconds) {
  const std::lock_guard lock(mutex_);
  times_.push_back(static_cast<float>(seconds));
}

uint64_t Tally::violations() const {
  const std::lock_guard lock(mutex_);
  uint64_t sum = 0;
  for (const auto& [kind, row] : rows_) sum += row.violations;
  return sum;
}

void Tally::print() const {
  const std::lock_guard lock(mutex_);
  std::printf("\n%-22s %10s %10s %10s %10s\n", "kind", "answered", "refused", "left", "WRONG");
  Row sum;
  const auto print_row = [](const char* kind, const Row& row) {
    std::printf("%-22s %10lu %10lu %10lu %10lu\n", kind, row.good, row.refused, row.without_answer, row.violations);
  };
  for (const auto& [kind, row] : rows_) {
    print_row(kind.c_str(), row);
    sum.good += row.good;
    sum.refused += row.refused;
    sum.without_answer += row.without_answer;
    sum.violations += row.violations;
  }
  print_row("all", sum);
  std::printf("\nrefused, by code:\n");
  for (const auto& [code, count] : codes_) std::printf("  %-30s %10lu\n", code.c_str(), count);
  if (!times_.empty()) {
    std::vector<float> sorted = times_;
    std::ranges::sort(sorted);
    std::printf("\nsmall requests among all this: %zu, p50 %.1f ms, p95 %.1f ms, p99 %.1f ms\n", sorted.size(),
                1e3 * percentile(sorted, 0.5), 1e3 * percentile(sorted, 0.95), 1e3 * percentile(sorted, 0.99));
  }
  for (const std::string& word : words_) std::printf("WRONG: %s\n", word.c_str());
}

}  // namespace papilio::soak
