#pragma once

#include <string>
#include <vector>

namespace papilio::bench {

/// A table as README has them: padded, so that it reads well unrendered too.
class MarkdownTable {
 public:
  explicit MarkdownTable(std::vector<std::string> header) : rows_{std::move(header)} {}

  /// As many cells as the header has.
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  /// To standard output: the first column on the left, the others on the right.
  void print() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// With so many digits behind the point.
[[nodiscard]] std::string fixed(double value, int digits);

}  // namespace papilio::bench
