#include "detail/check_levels.h"
#include "detail/level_decoder.h"
#include "papilio/detail.h"
#include "papilio/error.h"

namespace papilio {

TriangleMesh decode_detail(const DetailBase& base, std::span<const DetailStream> levels, uint64_t face_limit,
                           const std::function<bool()>& cancelled) {
  LevelDecoder decoder(mesh_of_base(base));
  check_levels(decoder.topology().face_count(), levels, face_limit);
  for (const DetailStream& stream : levels) {
    if (cancelled && cancelled()) throw Error(Fault::cancelled, "Decoding was cancelled.");
    decoder.decode(stream);
  }
  const Topology& t = decoder.topology();
  TriangleMesh made;
  made.positions = decoder.take_positions();
  made.triangles.reserve(t.face_count());
  for (uint32_t h = 0; h < t.half_edge_count(); h += 3)
    made.triangles.push_back({t.origin[h], t.origin[h + 1], t.origin[h + 2]});
  return made;
}

}  // namespace papilio
