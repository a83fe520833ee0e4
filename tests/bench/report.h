#pragma once

#include <functional>
#include <string>
#include <vector>

namespace papilio::bench {

/// One figure beside the one it is compared to, for --json.
struct ReportRow {
  std::string name;
  double ours = 0, peer = 0;
  std::string unit;
};

/// What is computed, not timed. Runs when asked for by its whole name, and only then.
struct Report {
  std::string name;
  std::function<std::vector<ReportRow>()> print;  ///< tables to standard output, progress to standard error
};

/// Adds a report. Called at start.
void add(Report report);

/// Each report adds itself.
void add_table1();
void add_quality();
void add_memory();
void add_wasm();
/// `only`: names of models; all if empty.
void add_detail(const std::vector<std::string>& only);

}  // namespace papilio::bench
