#pragma once

#include <string>
#include <vector>

namespace papilio::bench {

/// A Markdown table, padded to be readable unrendered.
class MarkdownTable {
 public:
  explicit MarkdownTable(std::vector<std::string> header) : rows_{std::move(header)} {}

  /// Adds a row with as many cells as the header.
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  /// Prints to standard output: the first column left-aligned, the others right-aligned.
  void print() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// Formats a number with this many decimals.
[[nodiscard]] std::string fixed(double value, int digits);

}  // namespace papilio::bench
