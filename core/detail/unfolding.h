#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/poller.h"
#include "detail/surface_place.h"
#include "papilio/mesh.h"

namespace papilio {

/// Faces round a vertex, laid out in the plane with the vertex at the origin, and the fan that covers their polygon
/// once the vertex has moved onto its first neighbour. A curve through the vertex becomes a straight line, with half a
/// turn on each side. Beyond a boundary lies a gap in place of a face.
class Unfolding {
 public:
  void clear();
  /// Adds a face, counter-clockwise: its half-edge that leaves the vertex, the half-edge's length, and the face's angle
  /// at the vertex.
  void add(uint32_t half_edge, double length, double angle);
  /// Adds the gap beyond a boundary, between the tips of two boundary edges; `length` is that of the first.
  void add_gap(double length) { add(none, length, 1); }
  /// Lays the faces out: scales angles, and keeps lengths. A curve through the vertex runs from the first tip to tip
  /// `curve_tip`; 0: no curve.
  void lay_out(size_t curve_tip = 0);
  /// Returns whether every face is positively oriented before and after, and thick enough after.
  [[nodiscard]] bool is_valid() const;

 private:
  friend class UnfoldingSequence;
  struct Face {
    uint32_t half_edge;  ///< half-edge that leaves the vertex; `none` in a gap
    double length, angle;
    double x, y;  ///< position of the half-edge's tip
  };
  std::vector<Face> faces_;
};

/// Unfoldings of a sequence of collapses.
class UnfoldingSequence {
 public:
  void push(const Unfolding& unfolding);
  [[nodiscard]] size_t size() const { return first_.size() - 1; }
  /// Moves places from the surface after the first `count` collapses to the original, which has `faces` faces.
  void lift(std::vector<SurfacePlace>& places, size_t count, uint32_t faces, const Poller& poller) const;

 private:
  struct Spoke {
    uint32_t half_edge;
    float x, y;
  };
  std::vector<Spoke> spokes_;
  std::vector<size_t> first_{0};
};

}  // namespace papilio
