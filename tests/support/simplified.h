#pragma once

#include <array>
#include <set>
#include <vector>

#include "core/simplify/simplify.h"
#include "papilio/mesh.h"
#include "papilio/view.h"

// Checks of meshes whose hidden faces were simplified.

namespace papilio::test {

using Place = std::array<float, 3>;
[[nodiscard]] Place place(Vec3f p);

[[nodiscard]] std::vector<bool> hidden_from(const Mesh& mesh, const View& view);
[[nodiscard]] size_t count_true(const std::vector<bool>& flags);

/// Returns a view of the mesh from a direction; `distance` is a multiple of its diagonal.
[[nodiscard]] View looking_at(const Mesh& mesh, Vec3d direction, double distance);
/// Returns a view with the mesh behind the eye.
[[nodiscard]] View looking_elsewhere(const Mesh& mesh);
/// Returns views of the whole mesh, of its front in parallel projection, and of a small part from nearby.
[[nodiscard]] std::vector<View> views_of(const Mesh& mesh);

/// Returns the boundary half-edges by the positions of their ends.
[[nodiscard]] std::multiset<std::array<Place, 2>> open_half_edges(const Mesh& mesh);

/// Simplifies and expects all invariants. Returns the result.
Mesh simplify_checked(const Mesh& mesh, const View& view, double error = default_hidden_error);
/// Returns the remaining share of the hidden faces.
[[nodiscard]] double share_left(const Mesh& before, const View& view, const Mesh& after);

}  // namespace papilio::test
