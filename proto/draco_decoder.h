#pragma once

#include <draco/mesh/mesh.h>

#include <memory>
#include <string_view>
#include <vector>

#include "papilio/mesh.h"
#include "proto/limits.h"

// A Draco mesh as libdraco decodes it, for those who read a part of it. read_draco() converts all.

namespace papilio::proto {

/// Decodes a stream with bounded work. The mesh has faces. Throws `Problem` as `read_draco`.
[[nodiscard]] std::unique_ptr<draco::Mesh> decode_draco(std::string_view bytes, const Limits& limits);

/// Returns the positions of the points. Throws `Problem`: mesh_unsupported, mesh_unusable.
[[nodiscard]] Buffer<Vec3f> read_positions(const draco::Mesh& mesh);
/// Returns the faces. Throws `Problem` mesh_unusable for an index out of range.
[[nodiscard]] Buffer<Triangle> read_triangles(const draco::Mesh& mesh);
/// Returns the values of the points. Throws `Problem`: mesh_not_draco, mesh_unusable.
[[nodiscard]] std::vector<double> read_values(const draco::PointAttribute& attribute, uint32_t points);

}  // namespace papilio::proto
