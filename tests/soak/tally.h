#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace papilio::soak {

/// Outcomes of all requests so far. Thread-safe.
class Tally {
 public:
  /// Counts an allowed answer by its status and the code of its problem document; empty: it has none.
  void count(const std::string& kind, int status, const std::string& code = {});
  /// Counts a connection that either side closed early, where that is allowed.
  void count_without_answer(const std::string& kind);
  /// Counts a failure; keeps the text of the first few.
  void violate(const std::string& kind, const std::string& what);
  /// Adds the time of a small request, in seconds.
  void time(double seconds);

  [[nodiscard]] uint64_t violations() const;
  /// Prints a table of kinds, failures by code, and percentiles.
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
