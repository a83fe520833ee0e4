#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilio/mesh.h"
#include "proto/gltf/accessor.h"
#include "proto/limits.h"

// Triangles of a glTF mesh in any storage.

namespace papilio::proto::gltf {

/// One attribute of vertices.
struct VertexStream {
  std::string semantic;                ///< "POSITION", "TEXCOORD_0", ...
  std::optional<uint32_t> accessor{};  ///< accessor in the document; nothing for a new one
  Elements elements{};
};

/// Vertices that one or several primitives of a mesh index.
struct VertexSet {
  uint64_t count = 0;
  std::vector<VertexStream> attributes;
  std::vector<std::vector<VertexStream>> targets;  ///< displacements by morph target

  /// Returns the attribute of this name; null if there is none.
  [[nodiscard]] const VertexStream* find(const std::string& semantic) const;
};

/// Returns the elements of a semantic; null if there are none with 3 components.
[[nodiscard]] const Elements* find_vectors(const std::vector<VertexStream>& streams, std::string_view semantic);

/// Returns the bytes of a vertex's attributes and morph targets.
[[nodiscard]] uint64_t bytes_of_vertex(const VertexSet& set);

/// Primitive of triangles.
struct TrianglePrimitive {
  uint32_t number = 0;  ///< index in its mesh
  uint32_t set = 0;     ///< index of its vertices in MeshGeometry::sets
  Buffer<Triangle> triangles;
};

/// Triangles of a mesh. Primitives of points and lines are skipped.
struct MeshGeometry {
  std::vector<VertexSet> sets;
  std::vector<TrianglePrimitive> primitives;
};

/// Remaining faces and vertices that meshes of a scene may have.
struct Allowance {
  explicit Allowance(const Limits& limits)
      : faces(limits.max_input_faces), points(limits.max_input_vertices + 3 * limits.max_input_faces) {}
  uint64_t faces, points;
};

/// Topology of a primitive, by glTF's number.
enum class PrimitiveMode : uint32_t { triangles = 4, strip = 5, fan = 6 };

/// Returns the mode of a primitive; nothing for points and lines. Throws `Problem` for other numbers.
[[nodiscard]] std::optional<PrimitiveMode> triangle_mode(const Json& primitive, const std::string& where);

/// Reads the triangles of a mesh: lists, strips and fans, indexed or not, compressed by KHR_draco_mesh_compression or
/// not. Returned indices are in range. Subtracts counts from `allowance`, and checks them before any allocation. Throws
/// `Problem`: mesh_not_gltf, mesh_unsupported, mesh_too_large, mesh_unusable (an index out of range).
[[nodiscard]] MeshGeometry read_geometry(Views& views, uint32_t mesh, Allowance& allowance);

}  // namespace papilio::proto::gltf
