#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "papilio/prepared_mesh.h"
#include "proto/draco_writer.h"
#include "proto/limits.h"

namespace papilio::proto {

/// A decoded and checked mesh, with the grids for encoding its refinements.
struct DecodedMesh {
  Mesh mesh;
  BuildReport found;
  QuantizationBox box;
  AttributeEncoding attributes;
};

/// Decodes and checks a mesh. Throws `Problem`.
[[nodiscard]] DecodedMesh decode_mesh(std::string_view draco, const Limits& limits);

/// A decoded mesh, shared by refinements, and a cache of their prepared meshes, one for each set of rules. Thread-safe.
class SharedMesh {
 public:
  /// `byte_budget`: limit of cached bytes, besides the mesh itself and the level of its own edges. Throws `Problem`.
  SharedMesh(std::string_view draco, const Limits& limits, uint64_t byte_budget);

  [[nodiscard]] const DecodedMesh& decoded() const { return decoded_; }
  /// Returns the mesh for the rules (tension, shape, w, crease angle) of the options, computed on first use. Least
  /// recently used meshes are evicted beyond the budget.
  [[nodiscard]] std::shared_ptr<const papilio::PreparedMesh> for_rules_of(const Options& options) const;
  /// Returns the bytes in memory.
  [[nodiscard]] uint64_t bytes() const;

 private:
  using CoreMesh = std::shared_ptr<const papilio::PreparedMesh>;
  [[nodiscard]] CoreMesh find(const Options& options) const;

  DecodedMesh decoded_;
  uint64_t budget_;
  mutable std::mutex access_;             ///< guards `recent_`
  mutable std::vector<CoreMesh> recent_;  ///< most recently used first
};

}  // namespace papilio::proto
