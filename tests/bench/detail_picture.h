#pragma once

#include <string>
#include <vector>

#include "tests/support/rate_curve.h"

namespace papilio::bench {

/// Lower envelope of a method on one model.
struct DetailCurve {
  std::string method;
  std::vector<test::RatePoint> envelope;
};
struct DetailPanel {
  std::string title;
  std::vector<DetailCurve> curves;  ///< of all methods, in the same order in every panel
};

/// SVG with a panel for each model: RMS distance over bytes, both logarithmic, the axes equal in all panels.
[[nodiscard]] std::string detail_picture(const std::vector<DetailPanel>& panels);

}  // namespace papilio::bench
