#include "client/mesh_file/sound_mesh.h"

#include <algorithm>

namespace papilio::client {

std::optional<std::string> find_broken(const TriangleMesh& mesh) {
  const auto is_broken = [count = mesh.positions.size()](const Triangle& triangle) {
    return std::ranges::any_of(triangle, [count](uint32_t vertex) { return vertex >= count; });
  };
  const auto broken = std::ranges::find_if(mesh.triangles, is_broken);
  if (broken == mesh.triangles.end()) return std::nullopt;
  return "triangle " + std::to_string(broken - mesh.triangles.begin()) + " (the first is 0) names vertex " +
         std::to_string(std::ranges::max(*broken)) + " (the first is 0), but there are " +
         std::to_string(mesh.positions.size()) + " vertices";
}

std::optional<std::string> find_fault(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return "holds no triangles";
  return find_broken(mesh);
}

}  // namespace papilio::client
