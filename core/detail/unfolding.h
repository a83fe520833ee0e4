#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "detail/surface_place.h"
#include "papilio/mesh.h"

namespace papilio {

/// Faces round a vertex, laid out in the plane with the vertex at the origin; and the fan that covers the same polygon
/// once the vertex has moved onto the first of its neighbours. A curve through the vertex is laid out as a straight
/// line: each side of it has half a turn. Beyond a boundary lies a gap in place of a face.
class Unfolding {
 public:
  void clear();
  /// Adds a face, counter-clockwise: the half-edge that leaves the vertex in it, its length, and the face's angle
  /// there.
  void add(uint32_t half_edge, double length, double angle);
  /// Adds the gap beyond a boundary, between the tip of a boundary edge and that of the next one.
  void add_gap(double length) { add(none, length, 1); }
  /// Lays the faces out: angles in proportion, lengths as they are. A curve through the vertex goes from the first tip
  /// to that of this number; 0: there is none.
  void lay_out(size_t curve_tip = 0);
  /// Whether every face is positively oriented before and after, and clearly so after.
  [[nodiscard]] bool is_valid() const;

 private:
  friend class UnfoldingSequence;
  struct Face {
    uint32_t half_edge;  ///< none: a gap
    double length, angle;
    double x, y;  ///< of the half-edge's tip
  };
  std::vector<Face> faces_;
};

/// The unfoldings of a sequence of collapses.
class UnfoldingSequence {
 public:
  void push(const Unfolding& unfolding);
  [[nodiscard]] size_t size() const { return first_.size() - 1; }
  /// Moves places from the surface after the first `count` collapses to that before the first. `faces`: number of
  /// faces of that one. `poll` is called every few thousand collapses and may throw to stop.
  void lift(std::vector<SurfacePlace>& places, size_t count, uint32_t faces, const std::function<void()>& poll) const;

 private:
  struct Spoke {
    uint32_t half_edge;
    float x, y;
  };
  std::vector<Spoke> spokes_;
  std::vector<size_t> first_{0};
};

}  // namespace papilio
