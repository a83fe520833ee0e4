#pragma once

#include <functional>
#include <string>
#include <vector>

namespace papilio::bench {

/// A figure and its baseline, for --json.
struct ReportRow {
  std::string name;
  double ours = 0, peer = 0;
  std::string unit;
};

/// A report of computed, not timed, figures. Runs only if requested by its full name.
struct Report {
  std::string name;
  std::function<std::vector<ReportRow>()> print;  ///< tables to standard output, progress to standard error
};

/// Adds a report. Must be called before reports run.
void add(Report report);

/// Each adds its report.
void add_table1();
void add_quality();
void add_picture();
void add_memory();
void add_wasm();
/// Adds the report of detail. `only`: names of models; all if empty.
void add_detail(const std::vector<std::string>& only);

}  // namespace papilio::bench
