#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "papilio/prepared_mesh.h"

namespace papilio::proto {

/// Cache of prepared meshes of one coarse mesh, one for each set of rules. Thread-safe.
class PreparedMeshes {
 public:
  /// `byte_budget`: limit of cached bytes, besides the mesh itself and the level of its own edges.
  explicit PreparedMeshes(uint64_t byte_budget) : budget_(byte_budget) {}

  /// Returns the mesh prepared for the rules (tension, shape, w, crease angle) of the options, computed on first use.
  /// `coarse` must be equal in each call. Least recently used meshes are evicted beyond the budget.
  [[nodiscard]] std::shared_ptr<const PreparedMesh> for_rules_of(const Mesh& coarse, const Options& options) const;
  [[nodiscard]] uint64_t bytes() const;

 private:
  using Prepared = std::shared_ptr<const PreparedMesh>;
  [[nodiscard]] Prepared find(const Options& options) const;

  uint64_t budget_;
  mutable std::mutex access_;             ///< guards `recent_`
  mutable std::vector<Prepared> recent_;  ///< most recently used first
};

/// Returns the bytes of a mesh in memory, with its detail.
[[nodiscard]] uint64_t bytes_of(const Mesh& mesh);

}  // namespace papilio::proto
