#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilio/mesh.h"
#include "proto/gltf/accessor.h"
#include "proto/limits.h"

// Triangles of a glTF mesh, however they are stored.

namespace papilio::proto::gltf {

/// One attribute of vertices.
struct VertexStream {
  std::string semantic;                ///< "POSITION", "TEXCOORD_0", ...
  std::optional<uint32_t> accessor{};  ///< nothing: a new one
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

/// Returns the elements of this name; null if there are none of three numbers each.
[[nodiscard]] const Elements* find_vectors(const std::vector<VertexStream>& streams, std::string_view semantic);

/// Returns the bytes of a vertex's attributes and morph targets.
[[nodiscard]] uint64_t bytes_of_vertex(const VertexSet& set);

/// A primitive of triangles.
struct TrianglePrimitive {
  uint32_t number = 0;  ///< in its mesh
  uint32_t set = 0;     ///< its vertices in MeshGeometry::sets
  Buffer<Triangle> triangles;
};

/// What a mesh has of triangles. Primitives of points and lines are left out.
struct MeshGeometry {
  std::vector<VertexSet> sets;
  std::vector<TrianglePrimitive> primitives;
};

/// What the meshes of a scene may still have.
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
/// not. Indices are in range. Counts are subtracted from `allowance`, and checked before anything is allocated. Throws
/// `Problem`: mesh_not_gltf, mesh_unsupported, mesh_too_large, mesh_unusable (an index out of range).
[[nodiscard]] MeshGeometry read_geometry(Views& views, uint32_t mesh, Allowance& allowance);

}  // namespace papilio::proto::gltf
