#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "papilio/detail.h"
#include "proto/draco_writer.h"
#include "proto/limits.h"
#include "proto/prepared_meshes.h"

namespace papilio::proto {

/// Decoded and checked mesh, with the grids for encoding its refinements.
struct DecodedMesh {
  Mesh mesh;
  BuildReport found;
  QuantizationBox box;
  AttributeEncoding attributes;
  NormalStyle normals{};  ///< style of a packed model's original normals
};

/// Decodes and checks a mesh: a Draco stream, or a packed model (proto/detail.md), whose levels are attached to its
/// base. Throws `Problem`.
[[nodiscard]] DecodedMesh decode_mesh(std::string_view bytes, const Limits& limits);

/// Decoded mesh, shared by refinements, and a cache of prepared meshes, one for each set of rules. Thread-safe.
class SharedMesh {
 public:
  /// `byte_budget`: limit of cached bytes, besides the mesh itself and the level of its own edges. Throws `Problem`.
  SharedMesh(std::string_view bytes, const Limits& limits, uint64_t byte_budget);

  [[nodiscard]] const DecodedMesh& decoded() const { return decoded_; }
  /// Returns the mesh prepared for the options' rules, as PreparedMeshes::for_rules_of().
  [[nodiscard]] std::shared_ptr<const PreparedMesh> for_rules_of(const Options& options) const {
    return prepared_.for_rules_of(decoded_.mesh, options);
  }
  /// Returns the bytes in memory.
  [[nodiscard]] uint64_t bytes() const { return bytes_of(decoded_.mesh) + prepared_.bytes(); }

 private:
  DecodedMesh decoded_;
  PreparedMeshes prepared_;
};

}  // namespace papilio::proto
