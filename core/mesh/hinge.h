#pragma once

#include <cmath>

#include "base/ids.h"
#include "papilio/mesh.h"
#include "simd/extremes.h"

namespace papilio {

/// Two faces at a half-edge with a twin.
class Hinge {
 public:
  [[gnu::always_inline]] Hinge(const Topology& mesh, const Buffer<Vec3f>& positions, HalfEdgeId h) {
    const auto at = [&](VertexId vertex) { return to_double(positions[vertex]); };
    const Vec3d a = at(mesh.origin[h]);
    const Vec3d along = at(mesh.tip(h)) - a;
    const Vec3d apex = at(mesh.apex(h)) - a;
    const Vec3d other_apex = at(mesh.apex(mesh.twin[h])) - a;
    normal_ = cross(along, apex);
    other_normal_ = cross(other_apex, along);
    along_ = along;
    const double squared = dot(normal_, normal_);
    const double other_squared = dot(other_normal_, other_normal_);
    squared_larger_ = larger(squared, other_squared);
    squared_lesser_ = lesser(squared, other_squared);
    volume_ = either(squared >= other_squared, dot(normal_, other_apex), dot(other_normal_, apex));
  }

  /// Returns whether the smaller face's apex is within `distance` of the larger face's plane.
  [[nodiscard]] bool is_flat(double distance) const {
    return std::abs(volume_) <= distance * std::sqrt(squared_larger_);
  }
  /// Returns the height of the smaller face above the edge.
  [[nodiscard]] double lesser_height() const {
    const double base = length(along_);
    return base > 0 ? std::sqrt(squared_lesser_) / base : 0;
  }
  /// Returns the cosine of the angle between the normals; 1 if a face has no area.
  [[nodiscard]] double cosine() const {
    const double lengths = length(normal_) * length(other_normal_);
    return lengths > 0 ? dot(normal_, other_normal_) / lengths : 1;
  }

 private:
  Vec3d normal_, other_normal_;             ///< normals as long as twice the faces' areas
  double squared_larger_, squared_lesser_;  ///< squared lengths of the normals
  Vec3d along_;                             ///< the edge
  double volume_;                           ///< six times the volume of the four vertices, by the larger face's plane
};

}  // namespace papilio
