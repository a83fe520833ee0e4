#include "proto/unreached.h"

#include "proto/text.h"

namespace papilio::proto {
namespace {

std::string what_to_do(StopReason reason, const Options& options) {
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
  return "Other criteria exclude edges: flatness, view.edge_pixels or the view.";
}

}  // namespace

std::string unreached_text(const Options& options, const Statistics& statistics) {
  std::string text;
  const auto add = [&](std::string_view target, double wanted, double left) {
    if (!statistics.stop_reason || !(wanted > 0 && left > wanted)) return;
    append_item(text, " ",
                std::string(target) + "=" + format_rounded(wanted) + " is not reached: the remaining error is " +
                    format_rounded(left) + ". " + what_to_do(*statistics.stop_reason, options));
  };
  add("tolerance", options.tolerance, statistics.error);
  if (options.view) add("view.error_pixels", options.view->error_pixels, statistics.error_pixels.value_or(0));
  return text;
}

}  // namespace papilio::proto
