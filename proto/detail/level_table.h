#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "papilio/detail.h"

namespace papilio::proto::detail {

/// Row of a packed model's table: one level.
struct LevelRow {
  float step = 0;      ///< quantization step of the residuals, in the unit of positions
  DetailReach reach;   ///< distances with all levels up to this one
  uint32_t bytes = 0;  ///< length of the residuals
  float texcoord_step = 0;
  uint32_t texcoord_bytes = 0;
  std::vector<DetailPiece> pieces{};  ///< pieces of a level with several
};

/// Head of a packed model's streams: their kinds and sizes (proto/detail.md, "Table").
struct LevelTable {
  uint32_t edges = 0;        ///< edges of the base
  uint32_t curve_bytes = 0;  ///< length of the base's curves
  DetailReach base_reach;
  bool has_texcoords = false;  ///< whether levels have residuals of texture coordinates
  bool has_pieces = false;     ///< whether rows have a number of pieces; 1 for a level without pieces
  std::vector<LevelRow> rows;  ///< levels, coarse first

  /// Returns the bytes of the table itself.
  [[nodiscard]] uint64_t size() const;
  /// Returns the bytes of the table and all streams.
  [[nodiscard]] uint64_t total() const;
};

/// Length of the prefix from which size_of_rows() reads.
inline constexpr size_t least_table_bytes = 18;

/// Returns the length of a table up to the end of its levels' rows, from its first `least_table_bytes` bytes. Throws
/// `Problem` if it has too many levels.
[[nodiscard]] uint64_t size_of_rows(std::string_view begin);
/// Returns the length of a table, from its first size_of_rows() bytes. Throws `Problem` if a level has no or too many
/// pieces.
[[nodiscard]] uint64_t size_of_table(std::string_view rows);

/// Writes a table, with distances rounded up to 32-bit floats. Throws `std::invalid_argument` for steps, distances and
/// bounds that read_table() refuses.
[[nodiscard]] std::string write_table(const LevelTable& table);

/// Reads a table. Throws `Problem` mesh_not_gltf: a step, distance or bound is out of its range, or the bytes of pieces
/// do not match their level.
[[nodiscard]] LevelTable read_table(std::string_view bytes);

}  // namespace papilio::proto::detail
