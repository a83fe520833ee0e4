#include "detail/check_levels.h"
#include "detail/level_decoder.h"
#include "papilio/detail.h"
#include "papilio/error.h"

namespace papilio {

Mesh decode_detail(const DetailBase& base, std::span<const DetailStream> levels, uint64_t face_limit,
                   const std::function<bool()>& cancelled) {
  LevelDecoder decoder(mesh_of_base(base), true);
  check_levels(decoder.topology().face_count(), levels, face_limit);
  for (const DetailStream& stream : levels) {
    if (cancelled && cancelled()) throw Error(Fault::cancelled, "Decoding was cancelled.");
    decoder.decode(stream);
  }
  return decoder.take_mesh();
}

}  // namespace papilio
