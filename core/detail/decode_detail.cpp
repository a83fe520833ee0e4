#include "detail/check_levels.h"
#include "detail/level_decoder.h"
#include "papilio/detail.h"
#include "papilio/error.h"

namespace papilio {

Mesh decode_detail_mesh(const DetailBase& base, std::span<const DetailStream> levels, uint64_t face_limit,
                        const std::function<bool()>& cancelled) {
  LevelDecoder decoder(mesh_of_base(base), true);
  check_levels(decoder.topology().face_count(), levels, face_limit);
  for (const DetailStream& stream : levels) {
    if (cancelled && cancelled()) throw Error(Fault::cancelled, "Decoding was cancelled.");
    decoder.decode(stream);
  }
  return decoder.take_mesh();
}

std::vector<std::vector<uint8_t>> decodable_pieces(const DetailBase& base, std::span<const DetailStream> levels) {
  const Mesh mesh = mesh_of_base(base);
  check_levels(mesh.topology.face_count(), levels, face_count_limit);
  const PieceOrder order(mesh);
  PieceNeeds needs(mesh.topology.vertex_count);
  std::vector<std::vector<uint8_t>> made;
  for (const DetailStream& stream : levels) made.push_back(needs.next(order, pieces_of(stream)));
  return made;
}

TriangleMesh decode_detail(const DetailBase& base, std::span<const DetailStream> levels, uint64_t face_limit,
                           const std::function<bool()>& cancelled) {
  return decode_detail_mesh(base, levels, face_limit, cancelled).triangles();
}

}  // namespace papilio
