#include "tests/bench/detail_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/bench/markdown_table.h"
#include "tests/support/detail_baseline.h"

namespace papilio::bench {
namespace {

using test::RatePoint;

constexpr int columns = 3;
constexpr double panel_width = 320, panel_height = 250;
constexpr double left = 50, right = 24, top = 26, bottom = 34, legend_height = 34;
constexpr std::array<const char*, 6> colours = {"#888888", "#e69f00", "#56b4e9", "#0072b2", "#d55e00", "#009e73"};
constexpr std::array<double, 5> rms_ticks = {0.05, 0.02, 0.01, 0.005, 0.003};

struct Range {
  double low, high;
  /// Returns the position between low and high, 0..1, in logarithms.
  [[nodiscard]] double share(double value) const { return std::log(value / low) / std::log(high / low); }
};
constexpr Range rms_range{test::finest_rms, test::coarsest_rms};

const char* colour(size_t method) { return colours[method % colours.size()]; }

std::string number(double value) { return fixed(value, 1); }

/// Formats a number without trailing zeros.
std::string short_number(double value) {
  std::string text = fixed(value, 3);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\">" + text + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) +
         "\" stroke=\"#dddddd\"/>\n";
}

/// Returns the part of an envelope inside the axes, with its ends on the border.
std::vector<RatePoint> shown(const std::vector<RatePoint>& envelope) {
  std::vector<RatePoint> points;
  std::ranges::copy_if(envelope, std::back_inserter(points),
                       [](const RatePoint& point) { return point.rms > rms_range.low && point.rms < rms_range.high; });
  if (const auto first = at_rms(envelope, rms_range.high); first && first->rms == rms_range.high)
    points.insert(points.begin(), *first);
  if (const auto last = at_rms(envelope, rms_range.low); last && last->rms == rms_range.low) points.push_back(*last);
  return points;
}

Range byte_range(const std::vector<DetailPanel>& panels) {
  Range range{1e5, 1e3};
  for (const DetailPanel& panel : panels)
    for (const DetailCurve& curve : panel.curves)
      for (const RatePoint& point : shown(curve.envelope))
        range = {std::min(range.low, point.bytes), std::max(range.high, point.bytes)};
  return {0.9 * range.low, 1.1 * range.high};
}

/// Draws one panel with its corner at the origin.
class Panel {
 public:
  explicit Panel(const Range& bytes) : bytes_(bytes) {}

  [[nodiscard]] std::string draw(const DetailPanel& panel) const {
    std::string svg =
        text_at(left, top - 8, "start", "<tspan font-weight=\"bold\">" + panel.title + "</tspan>") + axes();
    for (size_t m = 0; m < panel.curves.size(); ++m) svg += curve(shown(panel.curves[m].envelope), colour(m));
    return svg;
  }

 private:
  [[nodiscard]] double x(double bytes) const { return left + (panel_width - left - right) * bytes_.share(bytes); }
  [[nodiscard]] static double y(double rms) {
    return panel_height - bottom - (panel_height - top - bottom) * rms_range.share(rms);
  }

  [[nodiscard]] std::string axes() const {
    std::string svg;
    for (const double rms : rms_ticks)
      svg += line(left, y(rms), panel_width - right, y(rms)) + text_at(left - 5, y(rms) + 4, "end", short_number(rms));
    for (double bytes = std::pow(10, std::ceil(std::log10(bytes_.low))); bytes <= bytes_.high; bytes *= 10) {
      const std::string label = bytes < 1000 ? fixed(bytes, 0) : fixed(bytes / 1000, 0) + " kB";
      svg += line(x(bytes), top, x(bytes), panel_height - bottom) +
             text_at(x(bytes), panel_height - bottom + 15, "middle", label);
    }
    return svg;
  }

  [[nodiscard]] std::string curve(const std::vector<RatePoint>& points, const std::string& stroke) const {
    std::string svg = "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" + stroke + "\" points=\"";
    for (const RatePoint& point : points) svg += number(x(point.bytes)) + "," + number(y(point.rms)) + " ";
    return svg + "\"/>\n";
  }

  Range bytes_;
};

std::string legend(const DetailPanel& panel) {
  std::string svg = text_at(left, 20, "start", "RMS distance, % of the diagonal, over bytes:");
  double x = left + 290;
  for (size_t m = 0; m < panel.curves.size(); ++m) {
    svg += "<rect width=\"18\" height=\"3\" x=\"" + number(x) + "\" y=\"15\" fill=\"" + colour(m) + "\"/>\n" +
           text_at(x + 24, 20, "start", panel.curves[m].method);
    x += 48 + 6.5 * static_cast<double>(panel.curves[m].method.size());
  }
  return svg;
}

}  // namespace

std::string detail_picture(const std::vector<DetailPanel>& panels) {
  const Panel panel(byte_range(panels));
  const auto rows = static_cast<double>((panels.size() + columns - 1) / columns);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(columns * panel_width) +
                    "\" height=\"" + number(legend_height + rows * panel_height) +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n" +
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  if (!panels.empty()) svg += legend(panels.front());
  for (size_t i = 0; i < panels.size(); ++i)
    svg += "<g transform=\"translate(" + number(panel_width * static_cast<double>(i % columns)) + "," +
           number(legend_height + panel_height * static_cast<double>(i / columns)) + ")\">\n" + panel.draw(panels[i]) +
           "</g>\n";
  return svg + "</svg>\n";
}

}  // namespace papilio::bench
