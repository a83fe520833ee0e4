#include "proto/name_suggestion.h"

#include <algorithm>
#include <vector>

namespace papilio::proto {
namespace {

constexpr size_t most_edits = 3;

/// Returns the optimal string alignment distance: each pair of neighbours is swapped at most once.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    before_last = last;
    last = row;
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::optional<std::string_view> suggest_name(std::string_view typed, std::span<const std::string_view> names) {
  std::optional<std::string_view> nearest;
  size_t least = most_edits + 1;
  for (const std::string_view name : names) {
    for (const std::string_view form : {name, name.substr(name.find('.') + 1)}) {
      const size_t allowed = std::min(form.size() / 3, most_edits);
      if (typed.size() > form.size() + allowed) continue;
      const size_t distance = edit_distance(typed, form);
      if (distance > allowed || distance >= least) continue;
      nearest = name;
      least = distance;
    }
  }
  return nearest;
}

}  // namespace papilio::proto
