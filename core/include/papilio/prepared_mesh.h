#pragma once

#include <cstdint>
#include <memory>

#include "papilio/mesh.h"
#include "papilio/options.h"

namespace papilio {

/// A coarse mesh that is refined more than once. Positions of the red-green scheme depend on the mesh and on the rules
/// (tension, shape, w, crease angle), not on the view nor on any criterion: what requests needed of the hierarchy is
/// kept, and the next one, from another view say, costs the selection and the output.
///
/// What is kept grows by what each request needs in addition, up to a budget; what does not fit in is made for the one
/// request, and where it would fit alone it takes the place of what was kept. Any number of threads may use one object
/// at once. None waits for another: each works on what was kept when it began.
class PreparedMesh {
 public:
  /// Of `rules` only tension, shape, w and crease_angle are looked at. What cutting the coarse edges gives is computed
  /// here, and held whatever the budget; it bounds, in bytes, all that is held. Throws `Error` bad_option,
  /// out_of_memory.
  PreparedMesh(Mesh coarse, const Options& rules, uint64_t byte_budget);
  PreparedMesh(const PreparedMesh&) = delete;
  PreparedMesh& operator=(const PreparedMesh&) = delete;
  ~PreparedMesh();

  /// With its creases marked.
  [[nodiscard]] const Mesh& coarse() const;
  /// Whether the options have the rules that it was prepared for.
  [[nodiscard]] bool suits(const Options& options) const;
  /// What it takes in memory now.
  [[nodiscard]] uint64_t bytes() const;

  /// Known to the library alone.
  class State;
  [[nodiscard]] const State& state() const { return *state_; }

 private:
  std::unique_ptr<const State> state_;
};

}  // namespace papilio
