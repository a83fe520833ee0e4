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

/// A mesh as it came, checked, with what it takes to write its refinements.
struct DecodedMesh {
  Mesh mesh;
  BuildReport found;
  QuantizationBox box;
  AttributeEncoding attributes;
};

/// Throws `Problem`.
[[nodiscard]] DecodedMesh decode_mesh(std::string_view draco, const Limits& limits);

/// A stored mesh, decoded once, and what refinements made of it (core/prepared_mesh.h). Any number of threads may use
/// one object at once.
class PreparedMesh {
 public:
  /// Keeps up to `byte_budget` bytes of what refinements make, besides the mesh itself and the level of its own edges.
  /// Throws `Problem`.
  PreparedMesh(std::string_view draco, const Limits& limits, uint64_t byte_budget);

  [[nodiscard]] const DecodedMesh& decoded() const { return decoded_; }
  /// The mesh under the rules (tension, w, crease angle) of the options: made when they are asked for first. Those
  /// asked for longest ago are given up where together they pass the budget.
  [[nodiscard]] std::shared_ptr<const papilio::PreparedMesh> under_rules_of(const Options& options) const;
  /// What all of it takes in memory now.
  [[nodiscard]] uint64_t bytes() const;

 private:
  using UnderRules = std::shared_ptr<const papilio::PreparedMesh>;
  [[nodiscard]] UnderRules find(const Options& options) const;

  DecodedMesh decoded_;
  uint64_t budget_;
  mutable std::mutex access_;               ///< to the one below
  mutable std::vector<UnderRules> in_use_;  ///< the latest asked for first
};

}  // namespace papilio::proto
