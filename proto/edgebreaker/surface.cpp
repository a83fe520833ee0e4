#include "proto/edgebreaker/surface.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "proto/edgebreaker/seams.h"

namespace papilio::proto::edgebreaker {
namespace {

/// Returns whether an edge has more than two faces, two vertices share several edges, or boundaries touch at a vertex.
bool has_several_fans_or_edges(const CornerMesh& mesh) {
  std::vector<std::pair<uint32_t, uint32_t>> open;
  std::vector<uint32_t> starts;
  for (uint32_t c : mesh.at_boundary()) {
    const uint32_t from = mesh.vertex(CornerMesh::next(c));
    const uint32_t to = mesh.vertex(CornerMesh::previous(c));
    open.emplace_back(std::minmax(from, to));
    starts.push_back(from);
  }
  const auto has_twice = [](auto& list) {
    std::ranges::sort(list);
    return std::ranges::adjacent_find(list) != list.end();
  };
  return has_twice(open) || has_twice(starts);
}

/// Finds the edges between faces with the same three vertices.
Seams seams_of_mirrored_faces(const CornerMesh& mesh) {
  Seams seams;
  seams.is_seam.assign(mesh.corner_count(), 0);
  for (uint32_t c = 0; c < mesh.corner_count(); ++c) {
    const uint32_t other = mesh.opposite(c);
    if (other != none && mesh.vertex(c) == mesh.vertex(other)) seams.is_seam[c] = 1;
  }
  return seams;
}

}  // namespace

Surface manifold_surface(const Topology& mesh) {
  CornerMesh whole(mesh);
  if (mesh.pinched.empty() && !whole.has_faces_folded_together() && !has_several_fans_or_edges(whole))
    return {std::move(whole)};
  Surface surface{cut_open(whole, seams_of_mirrored_faces(whole))};
  surface.vertex.resize_for_overwrite(surface.mesh.vertex_count());
  for (uint32_t c = 0; c < whole.corner_count(); ++c) surface.vertex[surface.mesh.vertex(c)] = whole.vertex(c);
  return surface;
}

}  // namespace papilio::proto::edgebreaker
