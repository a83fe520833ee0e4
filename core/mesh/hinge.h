#pragma once

#include <cmath>

#include "papilio/mesh.h"

namespace papilio {

/// The two faces at a half-edge that has a twin.
class Hinge {
 public:
  [[gnu::always_inline]] Hinge(const Topology& mesh, const Buffer<Vec3f>& positions, uint32_t h) {
    const auto at = [&](uint32_t vertex) { return to_double(positions[vertex]); };
    const Vec3d a = at(mesh.origin[h]);
    const Vec3d along = at(mesh.tip(h)) - a;
    const Vec3d apex = at(mesh.apex(h)) - a;
    const Vec3d other_apex = at(mesh.apex(mesh.twin[h])) - a;
    normal_ = cross(along, apex);
    other_normal_ = cross(other_apex, along);
    const bool is_larger = dot(normal_, normal_) >= dot(other_normal_, other_normal_);
    larger_ = is_larger ? normal_ : other_normal_;
    volume_ = dot(larger_, is_larger ? other_apex : apex);
  }

  /// Whether the smaller face's apex is this close to the plane of the larger one.
  [[nodiscard]] bool is_flat(double distance) const { return std::abs(volume_) <= distance * length(larger_); }
  /// Of the angle between the normals; 1 where a face has none.
  [[nodiscard]] double cosine() const {
    const double lengths = length(normal_) * length(other_normal_);
    return lengths > 0 ? dot(normal_, other_normal_) / lengths : 1;
  }

 private:
  Vec3d normal_, other_normal_;  ///< twice the faces' areas
  Vec3d larger_;                 ///< the longer one of them
  double volume_;                ///< six times that of the four vertices
};

}  // namespace papilio
