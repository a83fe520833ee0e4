#pragma once

#include <algorithm>
#include <string>

#include "papilio/detail.h"
#include "papilio/error.h"

namespace papilio {

/// Throws `Error` bad_option unless the pieces of a level, if it has any, match its bytes.
inline void check_pieces(uint64_t base_faces, const DetailStream& level) {
  if (level.pieces.empty()) return;
  if (level.pieces.size() > std::min<uint64_t>(base_faces, most_detail_pieces))
    throw Error(Fault::bad_option, "A level of detail has more pieces than its base has faces.", "pieces");
  uint64_t bytes = 0, texcoord_bytes = 0;
  for (const DetailPiece& piece : level.pieces) {
    if (piece.is_missing && piece.bytes + piece.texcoord_bytes > 0)
      throw Error(Fault::bad_option, "A piece of detail is missing and has bytes.", "pieces");
    bytes += piece.bytes;
    texcoord_bytes += piece.texcoord_bytes;
  }
  if (bytes != level.bytes.size() || texcoord_bytes != level.texcoords.bytes.size())
    throw Error(Fault::bad_option, "The pieces of a level of detail have other bytes than the level.", "pieces");
}

/// Throws `Error` bad_option or result_too_large unless the levels of a base of `base_faces` faces can be decoded
/// within the limit.
inline void check_levels(uint64_t base_faces, std::span<const DetailStream> levels, uint64_t face_limit) {
  if (levels.size() > static_cast<size_t>(most_detail_levels))
    throw Error(Fault::bad_option,
                "Detail has " + std::to_string(levels.size()) + " levels; at most " +
                    std::to_string(most_detail_levels) + " are decoded.",
                "levels");
  for (const DetailStream& level : levels) {
    if (!(level.step > 0 && level.step <= coordinate_limit))
      throw Error(Fault::bad_option, "A level of detail has a step that is not above 0.", "step");
    if (!(level.texcoords.step >= 0 && level.texcoords.step <= coordinate_limit))
      throw Error(Fault::bad_option, "A level of detail has a negative step of texture coordinates.", "step");
    check_pieces(base_faces, level);
  }
  const uint64_t faces = base_faces << (2 * levels.size());
  if (faces > std::min(face_limit, face_count_limit))
    throw Error(Fault::result_too_large, "Detail of " + std::to_string(levels.size()) + " levels has " +
                                             std::to_string(faces) + " faces, more than the limit of " +
                                             std::to_string(face_limit) + ". Decode fewer levels.");
}

}  // namespace papilio
