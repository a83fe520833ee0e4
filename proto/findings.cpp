#include "proto/findings.h"

#include <algorithm>
#include <array>

#include "proto/text.h"

namespace papilio::proto {
namespace {

struct Row {
  std::string_view name;
  uint32_t BuildReport::*count;
  bool is_defect;
};

constexpr std::array finding_rows{
    Row{"boundary_edges", &BuildReport::boundary_edges, false},
    Row{"non_manifold_edges", &BuildReport::non_manifold_edges, true},
    Row{"misoriented_edges", &BuildReport::misoriented_edges, true},
    Row{"pinched_vertices", &BuildReport::pinched_vertices, true},
    Row{"near_duplicates", &BuildReport::near_duplicates, true},
    Row{"t_junctions", &BuildReport::t_junctions, true},
    Row{"welded_points", &BuildReport::welded_points, false},
    Row{"isolated_points", &BuildReport::isolated_points, true},
    Row{"degenerate_faces", &BuildReport::degenerate_faces, true},
    Row{"repeated_faces", &BuildReport::repeated_faces, true},
};

}  // namespace

Findings all_findings(const BuildReport& report) {
  Findings found;
  for (const Row& row : finding_rows) found.emplace_back(row.name, report.*row.count);
  return found;
}

Findings defects(const BuildReport& report) {
  Findings found;
  for (const Row& row : finding_rows)
    if (row.is_defect && report.*row.count > 0) found.emplace_back(row.name, report.*row.count);
  return found;
}

std::string defects_text(const BuildReport& report) {
  std::string text;
  for (const auto& [name, count] : defects(report))
    append_item(text, ", ", std::string(name).append("=").append(std::to_string(count)));
  return text;
}

BuildReport parse_defects(std::string_view text) {
  BuildReport report;
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find(", "));
    text.remove_prefix(std::min(text.size(), item.size() + 2));
    const std::string_view name = item.substr(0, item.find('='));
    const auto row = std::ranges::find(finding_rows, name, &Row::name);
    if (row == finding_rows.end() || name.size() == item.size()) continue;
    const double count = parse_number(item.substr(name.size() + 1)).value_or(0);
    report.*row->count = static_cast<uint32_t>(std::clamp(count, 0.0, double{UINT32_MAX}));
  }
  return report;
}

}  // namespace papilio::proto
