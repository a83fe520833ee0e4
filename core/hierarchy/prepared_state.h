#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/mutex.h"
#include "hierarchy/hierarchy.h"
#include "papilio/prepared_mesh.h"
#include "papilio/result.h"

namespace papilio {

/// Levels shared by requests, the coarse one first.
using KeptLevels = std::vector<std::shared_ptr<const HierarchyLevel>>;

/// State of a prepared mesh. Thread-safe.
class PreparedMesh::State {
 public:
  State(Mesh coarse, const Options& rules, uint64_t byte_budget);

  [[nodiscard]] const Options& rules() const { return rules_; }
  [[nodiscard]] uint64_t budget() const { return budget_; }
  [[nodiscard]] const ShapeReport& shape() const { return shape_; }
  [[nodiscard]] KeptLevels kept() const;
  [[nodiscard]] uint64_t bytes() const;
  /// Replaces the kept levels, without the deepest ones that exceed the budget. Always keeps the coarse level.
  void keep(KeptLevels levels) const;

 private:
  Options rules_;
  uint64_t budget_;
  ShapeReport shape_;
  mutable Mutex access_;     ///< guards `kept_` and `bytes_`
  mutable KeptLevels kept_;  ///< kept levels, the coarse one first
  mutable uint64_t bytes_;
};

}  // namespace papilio
