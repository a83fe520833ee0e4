#pragma once

#include <cstdint>
#include <memory>

#include "papilio/mesh.h"
#include "papilio/options.h"

namespace papilio {

/// Coarse mesh to be refined more than once. Positions of the red-green scheme depend on the mesh and the rules
/// (tension, shape, w, crease angle), not on view or criteria. So the levels that a request computes are kept, and a
/// later request, for example from another view, costs selection and output only.
///
/// Kept levels grow with each request, up to a budget. Levels that exceed it serve one request; if they fit without the
/// kept ones, they replace them. Any number of threads may use one object at once without waiting: each works on the
/// levels that were kept when it began.
class PreparedMesh {
 public:
  /// Prepares the mesh for the tension, shape, w and crease_angle of `rules`; its other options have no effect.
  /// `byte_budget` is the upper bound of all kept bytes. The split of the coarse edges is computed here and kept beyond
  /// any budget. Throws `Error` bad_option, out_of_memory.
  PreparedMesh(Mesh coarse, const Options& rules, uint64_t byte_budget);
  PreparedMesh(const PreparedMesh&) = delete;
  PreparedMesh& operator=(const PreparedMesh&) = delete;
  ~PreparedMesh();

  /// Returns the coarse mesh with its creases marked.
  [[nodiscard]] const Mesh& coarse() const;
  /// Returns whether the options have the rules that the mesh was prepared for.
  [[nodiscard]] bool suits(const Options& options) const;
  /// Returns the bytes in memory now.
  [[nodiscard]] uint64_t bytes() const;

  /// Private to the library.
  class State;
  [[nodiscard]] const State& state() const { return *state_; }

 private:
  std::unique_ptr<const State> state_;
};

}  // namespace papilio
