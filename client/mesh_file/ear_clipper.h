#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace papilio::client {

/// Point of the plane.
struct Point2 {
  double x = 0, y = 0;
};

/// Triangulation of a polygon of the plane by ear clipping (Meisters 1975), shortest diagonal first. Ears thinner than
/// a thousandth of their longest side are clipped last. Corners may coincide and sides may touch, as at the bridge to a
/// hole. O(n^2).
class EarClipper {
 public:
  /// Takes counter-clockwise corners, with coordinates of magnitude 1 at most.
  explicit EarClipper(std::vector<Point2> corners);

  /// Returns n - 2 counter-clockwise triangles of corner numbers; nothing for a polygon that crosses itself.
  [[nodiscard]] std::vector<std::array<uint32_t, 3>> run();

 private:
  /// Order in which ears are clipped.
  enum class Rank : uint8_t { sound, thin, blocked };

  [[nodiscard]] bool crosses_itself() const;
  [[nodiscard]] bool is_blocked(uint32_t corner) const;
  void rank(uint32_t corner);
  [[nodiscard]] uint32_t best_ear() const;
  void clip(uint32_t ear);

  std::vector<Point2> points_;
  std::vector<uint32_t> before_, after_;  ///< neighbours in the remaining polygon
  std::vector<Rank> rank_;
  std::vector<double> diagonal_;  ///< squared length of the diagonal that clips the corner
  uint32_t first_ = 0;            ///< corner of the remaining polygon
};

}  // namespace papilio::client
