#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/trigonometry.h"

// Weights of the Modified Butterfly scheme. Each row sums to 1 and reproduces linear functions on its own regular
// layout. Sources: [DGL90] Dyn, Gregory, Levin, "A butterfly subdivision scheme for surface interpolation with tension
// control", 1990; [ZSS96] Zorin, Schroeder, Sweldens, "Interpolating subdivision for meshes with arbitrary topology",
// 1996; [SIG00] "Subdivision for modeling and animation", SIGGRAPH 2000 course notes.

namespace papilio::stencil {

/// Valence of a regular interior vertex, and triangles at a regular boundary or crease vertex, on one side.
inline constexpr uint32_t regular_valence = 6;
inline constexpr uint32_t regular_curve_triangles = 3;

/// Row for both ends interior and regular: the eight-point rule of [DGL90], with w > 0 the ten-point rule of [ZSS96].
template <class Real>
struct Regular {
  Real end, apex, wing, far;  ///< two ends, two apexes, four wings, two points in line with the edge
  explicit Regular(Real w = 0) : end(Real(0.5) - w), apex(Real(0.125) + 2 * w), wing(Real(-0.0625) - w), far(w) {}
};

/// Contribution of one of the edge's two faces to `Regular`: half of the ends, its apex, the two wings across its other
/// edges. Both contributions add up to the rule, without the points in line.
template <class Real>
struct FaceShare {
  Real end, apex, wing, far;
  explicit FaceShare(Real w = 0) : FaceShare(Regular<Real>(w)) {}
  explicit FaceShare(const Regular<Real>& row) : end(row.end / 2), apex(row.apex), wing(row.wing), far(row.far) {}

  template <class Point>
  [[nodiscard]] Point operator()(Point a, Point b, Point apex_point, Point wing_1, Point wing_2) const {
    return end * (a + b) + apex * apex_point + wing * (wing_1 + wing_2);
  }
};

/// Row along a boundary or crease: the four-point rule [SIG00]. Where the curve ends at a, its missing point is 2a - b.
template <class Real>
struct Curve {
  static constexpr Real end{9.0 / 16}, next{-1.0 / 16};
};

/// Row for one end A interior, the other B on a curve, both regular [SIG00]. P is their common neighbour on the
/// curve, Q the other.
template <class Real>
struct InteriorCurve {
  static constexpr Real a{5.0 / 8}, b{3.0 / 8}, p{1.0 / 16}, q{3.0 / 16};
  static constexpr Real b_next{-1.0 / 16};   ///< B's other neighbour on the curve
  static constexpr Real wing_ap{-1.0 / 16};  ///< across edge AP
  static constexpr Real wing_aq{-1.0 / 8};   ///< across edge AQ
};

/// Row for both ends on a curve and regular, as is one apex [SIG00]. (Curve on opposite sides: the midpoint.)
template <class Real>
struct CurveCurve {
  static constexpr Real end{0.5}, apex{0.25}, wing{-0.125};  ///< apex and wings on the inner side
};

/// Row of an interior vertex of valence K != 6 [ZSS96]: its own weight and the weights of its ring. j = 0 is the other
/// end of the edge; j counts round the vertex. For K = 2 (two faces back to back) there is no rule: the midpoint.
struct Interior {
  double centre;
  std::vector<double> ring;  ///< [K]
};
[[nodiscard]] Interior interior(uint32_t valence);

/// Weights of an interior vertex of valence K >= 5 as three harmonics of the ring, so that a whole fan costs O(K). With
/// m = sum p_j / K and, for n = 1, 2, c_n = sum cos(2 pi j n / K) p_j / K, s_n likewise with sin, the vertex of spoke i
/// is 3/4 centre + 1/4 m + cos(2 pi i / K) c_1 + sin(..) s_1 + 1/2 (cos(4 pi i / K) c_2 + sin(..) s_2).
inline constexpr double interior_centre = 0.75, harmonic_0 = 0.25, harmonic_1 = 1.0, harmonic_2 = 0.5;
/// Lowest valence for which the harmonics are used; below, the explicit weights.
inline constexpr uint32_t harmonic_valence = 33;

/// Row of a vertex on a curve with K triangles on this side, K != 3, for spoke i, 0 < i < K [ZSS96, corrected]. Its
/// neighbours are j = 0..K, 0 and K on the curve. The vertex of spoke i is centre a + end (p_0 - p_K) + sine_1 S_1 +
/// sine_2 S_2, S_n = sum sin(n j pi / K) p_j, 0 < j < K.
struct CurveSpoke {
  double centre, end, sine_1, sine_2;
};
class CurveRule {  // rows of all spokes of one vertex
 public:
  explicit CurveRule(uint32_t triangles);
  [[nodiscard]] CurveSpoke spoke(uint32_t i) const;
  /// Returns sin(i pi / K), i < 2 K.
  [[nodiscard]] double sine(uint32_t i) const {
    return i < angles_.size() ? angles_[i].sine : -angles_[i - angles_.size()].sine;
  }

 private:
  double triangles_;
  std::vector<SineCosine> angles_;        ///< [K] sines and cosines of multiples of pi / K
  double of_centre_, of_end_, over_end_;  ///< terms common to all spokes
};

}  // namespace papilio::stencil
