#include "proto/unreached.h"

#include "proto/text.h"

namespace papilio::proto {
namespace {

constexpr int most_position_bits = 16;

/// Returns the reason why a refinement without further edges to split left an error, and advice. `other_target`: the
/// target beside the unreached one; an edge is split only if both require it.
std::string why_converged(const Options& options, std::string_view other_target) {
  std::string criteria;
  const auto add = [&](bool is_given, std::string_view criterion) {
    if (is_given) append_item(criteria, ", ", criterion);
  };
  add(!options.flatness.empty(), "flatness");
  add(!other_target.empty(), other_target);
  add(options.view && options.view->edge_pixels > 0, "view.edge_pixels");
  add(options.view.has_value(), "the view");
  if (criteria.empty()) return "No further edge can be split.";
  return "Other criteria exclude edges: " + criteria + ". Omit them, or request a larger error.";
}

std::string what_to_do(StopReason reason, const Options& options, std::string_view other_target) {
  switch (reason) {
    case StopReason::levels:
      if (options.stop_at_limits) return std::to_string(options.levels) + " levels are the maximum.";
      return "Raise levels above " + std::to_string(options.levels) + ", or omit levels.";
    case StopReason::budget:
      return "Raise max_faces above " + std::to_string(options.max_faces) + ".";
    case StopReason::limits:
      return "A further level would exceed a limit on faces or memory. Request a larger error.";
    case StopReason::converged:
      break;
  }
  return why_converged(options, other_target);
}

std::string about_grid(const GridShare& grid) {
  const std::string bits = std::to_string(grid.bits);
  return "The grid of output.position_bits=" + bits + " accounts for " + format_rounded(grid.error) + " of it. " +
         (grid.bits < most_position_bits ? "Raise output.position_bits, or omit it."
                                         : bits + " bits are the maximum. Request a larger tolerance.");
}

}  // namespace

std::string unreached_text(const Options& options, const Statistics& statistics, const GridShare& grid) {
  std::string text;
  if (!statistics.stop_reason) return text;
  const auto add = [&](std::string_view target, double wanted, double left, const std::string& advice) {
    append_item(text, " ",
                std::string(target) + "=" + format_rounded(wanted) + " is not reached: the remaining error is " +
                    format_rounded(left) + ". " + advice);
  };
  const double pixels = options.view ? options.view->error_pixels : 0;
  const double pixels_left = statistics.error_pixels.value_or(0);
  if (options.tolerance > 0 && statistics.error > options.tolerance) {
    const bool is_due_to_grid = statistics.error - grid.error <= options.tolerance;
    add("tolerance", options.tolerance, statistics.error,
        is_due_to_grid ? about_grid(grid)
                       : what_to_do(*statistics.stop_reason, options, pixels > 0 ? "view.error_pixels" : ""));
  }
  if (pixels > 0 && pixels_left > pixels)
    add("view.error_pixels", pixels, pixels_left,
        what_to_do(*statistics.stop_reason, options, options.tolerance > 0 ? "tolerance" : ""));
  return text;
}

}  // namespace papilio::proto
