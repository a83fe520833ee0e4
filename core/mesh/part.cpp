#include "mesh/part.h"

namespace papilio {
namespace {

Buffer<uint8_t> edges_at(const Topology& mesh, const Buffer<uint32_t>& faces) {
  Buffer<uint8_t> marks(mesh.edge_count(), 0);
  for (uint32_t f : faces)
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) marks[mesh.edge[h]] = 1;
  return marks;
}

}  // namespace

Part::Part(const Topology& mesh, const Buffer<uint8_t>& marks)
    : faces(marks, Ranks::Others::alike), edges(edges_at(mesh, faces.numbers()), Ranks::Others::alike) {}

}  // namespace papilio
