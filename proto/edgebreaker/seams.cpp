#include "proto/edgebreaker/seams.h"

namespace papilio::proto::edgebreaker {

Seams find_seams(const CornerMesh& mesh, const Buffer<uint32_t>& corner_point, const OutputAttribute& attribute) {
  Seams seams;
  seams.value.resize_for_overwrite(mesh.corner_count());
  for (uint32_t c = 0; c < mesh.corner_count(); ++c) seams.value[c] = attribute.values.value[corner_point[c]];
  for (uint32_t c = 0; c < mesh.corner_count(); ++c) {
    const uint32_t other = mesh.opposite(c);
    if (other == none || other < c) continue;
    if (seams.value[CornerMesh::next(c)] == seams.value[CornerMesh::previous(other)] &&
        seams.value[CornerMesh::previous(c)] == seams.value[CornerMesh::next(other)])
      continue;
    if (seams.empty()) seams.is_seam.assign(mesh.corner_count(), 0);
    seams.is_seam[c] = seams.is_seam[other] = 1;
  }
  return seams;
}

CornerMesh cut_open(const CornerMesh& mesh, const Seams& seams) {
  Buffer<uint32_t> vertex(mesh.corner_count(), none);
  uint32_t vertices = 0;
  const auto left = [&](uint32_t c) { return seams.is_seam[CornerMesh::next(c)] != 0 ? none : mesh.swing_left(c); };
  const auto right = [&](uint32_t c) {
    return seams.is_seam[CornerMesh::previous(c)] != 0 ? none : mesh.swing_right(c);
  };
  for (uint32_t start = 0; start < mesh.corner_count(); ++start) {
    if (vertex[start] != none) continue;
    for (uint32_t c = start; c != none && vertex[c] == none; c = left(c)) vertex[c] = vertices;
    for (uint32_t c = right(start); c != none && vertex[c] == none; c = right(c)) vertex[c] = vertices;
    ++vertices;
  }
  return {mesh, seams.is_seam, vertex, vertices};
}

}  // namespace papilio::proto::edgebreaker
