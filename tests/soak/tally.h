#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace papilio::soak {

/// What has come of all requests so far. Threads share it.
class Tally {
 public:
  /// An answer that is allowed: its status, and its problem's public code if it is one ("" if not).
  void count(const std::string& kind, int status, const std::string& code = {});
  /// A connection that was left, or that the server closed, where that is allowed.
  void count_without_answer(const std::string& kind);
  /// Something that must not happen; the first few are kept word for word.
  void violate(const std::string& kind, const std::string& what);
  /// Seconds that a small request took.
  void time(double seconds);

  [[nodiscard]] uint64_t violations() const;
  /// The table of kinds, failures by code, and the percentiles, for people.
  void print() const;

 private:
  struct Row {
    uint64_t good = 0, refused = 0, without_answer = 0, violations = 0;
  };

  mutable std::mutex mutex_;
  std::map<std::string, Row> rows_;
  std::map<std::string, uint64_t> codes_;  ///< "429 busy"
  std::vector<std::string> words_;
  std::vector<float> times_;
};

}  // namespace papilio::soak
