#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// What a packed model's table says of one level.
struct LevelRow {
  float step = 0;      ///< quantization step of the residuals, in the unit of the positions
  DetailReach reach;   ///< of all levels up to this one
  uint32_t bytes = 0;  ///< of the residuals
  float texcoord_step = 0;
  uint32_t texcoord_bytes = 0;
  std::vector<DetailPiece> pieces{};  ///< of a level in several
};

/// Head of a packed model's streams: what they are, and their sizes (proto/detail.md, "Table").
struct LevelTable {
  uint32_t edges = 0;        ///< of the base
  uint32_t curve_bytes = 0;  ///< of the base's curves
  DetailReach base_reach;
  bool has_texcoords = false;  ///< whether levels have residuals of texture coordinates
  bool has_pieces = false;     ///< whether rows count pieces: one where a level has none of its own
  std::vector<LevelRow> rows;  ///< coarse first

  /// Bytes of the table itself.
  [[nodiscard]] uint64_t size() const;
  /// Bytes of the table and all streams.
  [[nodiscard]] uint64_t total() const;
};

/// Bytes from which size_of_rows() is known.
inline constexpr size_t least_table_bytes = 18;

/// Returns the bytes of a table up to the end of its levels' rows, from its first `least_table_bytes`. Throws `Problem`
/// where it has too many levels.
[[nodiscard]] uint64_t size_of_rows(std::string_view begin);
/// Returns the bytes of a table, from those up to the end of its levels' rows. Throws `Problem` where a level has no or
/// too many pieces.
[[nodiscard]] uint64_t size_of_table(std::string_view rows);

/// Writes a table; distances are rounded up to 32-bit floats. Throws `std::invalid_argument` for steps, distances and
/// bounds that read_table() refuses.
[[nodiscard]] std::string write_table(const LevelTable& table);

/// Reads a table of all its bytes. Throws `Problem`: `mesh_not_gltf` (a step, distance or bound out of its range,
/// pieces of other bytes than their level).
[[nodiscard]] LevelTable read_table(std::string_view bytes);

}  // namespace papilio::proto::detail
