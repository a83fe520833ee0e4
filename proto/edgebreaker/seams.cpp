#include "proto/edgebreaker/seams.h"

#include <algorithm>
#include <vector>

namespace papilio::proto::edgebreaker {
namespace {

/// Returns the points of the vertex of a corner.
uint32_t points_of_fan(const CornerMesh& mesh, uint32_t corner, std::span<const Seams> attributes) {
  uint32_t first = corner;
  for (uint32_t c = mesh.swing_right(corner); c != none && c != corner; c = mesh.swing_right(c)) first = c;
  const bool is_closed = mesh.swing_right(first) != none;
  // Calls visit(corner opposite to the edge) for each inner edge of the fan.
  const auto for_each_edge = [&](const auto& visit) {
    uint32_t c = first;
    do {
      const uint32_t left = mesh.swing_left(c);
      if (left != none) visit(CornerMesh::next(c));
      c = left;
    } while (c != none && c != first);
  };
  std::vector<const Seams*> dividing;
  for (const Seams& seams : attributes) {
    uint32_t count = 0;
    if (!seams.empty()) for_each_edge([&](uint32_t opposite) { count += seams.is_seam[opposite] != 0 ? 1 : 0; });
    if (count > (is_closed ? 1U : 0U)) dividing.push_back(&seams);
  }
  uint32_t divisions = 0;
  for_each_edge([&](uint32_t opposite) {
    const auto divides = [&](const Seams* seams) { return seams->is_seam[opposite] != 0; };
    divisions += std::ranges::any_of(dividing, divides) ? 1 : 0;
  });
  return is_closed ? std::max(divisions, 1U) : divisions + 1;
}

}  // namespace

Seams find_seams(const CornerMesh& mesh, const Buffer<uint32_t>& corner_point, const OutputAttribute& attribute) {
  Seams seams;
  auto value = Buffer<uint32_t>::for_overwrite(mesh.corner_count());
  for (uint32_t c = 0; c < mesh.corner_count(); ++c) value[c] = attribute.values.value[corner_point[c]];
  for (uint32_t c = 0; c < mesh.corner_count(); ++c) {
    const uint32_t other = mesh.opposite(c);
    if (other == none || other < c) continue;
    if (value[CornerMesh::next(c)] == value[CornerMesh::previous(other)] &&
        value[CornerMesh::previous(c)] == value[CornerMesh::next(other)])
      continue;
    if (seams.empty()) seams.is_seam.assign(mesh.corner_count(), 0);
    seams.is_seam[c] = seams.is_seam[other] = 1;
  }
  return seams;
}

uint32_t decoded_points(const CornerMesh& mesh, std::span<const Seams> attributes) {
  Buffer<uint8_t> is_done(mesh.vertex_count(), 0);
  uint32_t points = mesh.vertex_count();
  for (const Seams& seams : attributes)
    for (uint32_t c = 0; c < seams.is_seam.size(); ++c)
      for (const uint32_t corner : {CornerMesh::next(c), CornerMesh::previous(c)}) {
        uint8_t& done = is_done[mesh.vertex(corner)];
        if (seams.is_seam[c] == 0 || done != 0) continue;
        done = 1;
        points += points_of_fan(mesh, corner, attributes) - 1;
      }
  return points;
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
