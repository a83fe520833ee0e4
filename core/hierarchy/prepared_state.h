#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/mutex.h"
#include "hierarchy/hierarchy.h"
#include "papilio/prepared_mesh.h"
#include "papilio/result.h"

namespace papilio {

/// Levels that requests share, the coarse one first.
using KeptLevels = std::vector<std::shared_ptr<const HierarchyLevel>>;

/// What a prepared mesh holds. Any number of threads may use one object at once.
class PreparedMesh::State {
 public:
  State(Mesh coarse, const Options& rules, uint64_t byte_budget);

  [[nodiscard]] const Options& rules() const { return rules_; }
  [[nodiscard]] uint64_t budget() const { return budget_; }
  [[nodiscard]] double smallest_angle() const { return smallest_angle_; }
  [[nodiscard]] const ShapeReport& shape() const { return shape_; }
  [[nodiscard]] KeptLevels kept() const;
  [[nodiscard]] uint64_t bytes() const;
  /// Replaces what is kept, as far as the budget holds it.
  void keep(KeptLevels levels) const;

 private:
  Options rules_;
  uint64_t budget_;
  ShapeReport shape_;
  double smallest_angle_;    ///< of the coarse mesh, in radians
  mutable Mutex access_;     ///< to the two below
  mutable KeptLevels kept_;  ///< the coarse level first
  mutable uint64_t bytes_;
};

}  // namespace papilio
