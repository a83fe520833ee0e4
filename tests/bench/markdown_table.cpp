#include "tests/bench/markdown_table.h"

#include <algorithm>
#include <cstdio>

namespace papilio::bench {
namespace {

/// Returns the width in UTF-8 characters.
size_t width_of(const std::string& text) {
  return static_cast<size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

void MarkdownTable::print() const {
  std::vector<size_t> widths(rows_.front().size(), 3);
  for (const auto& row : rows_)
    for (size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  for (size_t r = 0; r < rows_.size(); ++r) {
    for (size_t i = 0; i < widths.size(); ++i) {
      const std::string padding(widths[i] - width_of(rows_[r][i]), ' ');
      const std::string cell = i == 0 ? rows_[r][i] + padding : padding + rows_[r][i];
      std::printf("| %s ", cell.c_str());
    }
    std::printf("|\n");
    if (r > 0) continue;
    for (size_t i = 0; i < widths.size(); ++i)
      std::printf("|%s%c", std::string(widths[i] + 1, '-').c_str(), i == 0 ? '-' : ':');
    std::printf("|\n");
  }
}

std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

}  // namespace papilio::bench
