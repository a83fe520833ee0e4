#include "proto/detail/level_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "proto/gltf/document.h"

namespace papilio::proto::detail {
namespace {

constexpr uint64_t row_bytes = 16;
constexpr uint64_t texcoord_row_bytes = 8;
constexpr uint64_t piece_count_bytes = 4;
constexpr uint64_t piece_bytes = 40;
constexpr uint64_t texcoord_piece_bytes = 4;
constexpr unsigned texcoord_flag = 1, piece_flag = 2;

/// Optional columns of the rows.
struct Flags {
  bool has_texcoords = false;
  bool has_pieces = false;

  [[nodiscard]] uint64_t row() const {
    return row_bytes + (has_texcoords ? texcoord_row_bytes : 0) + (has_pieces ? piece_count_bytes : 0);
  }
  [[nodiscard]] uint64_t piece() const { return piece_bytes + (has_texcoords ? texcoord_piece_bytes : 0); }
  [[nodiscard]] uint8_t byte() const {
    return static_cast<uint8_t>((has_texcoords ? texcoord_flag : 0) | (has_pieces ? piece_flag : 0));
  }
};

Flags flags_of(uint8_t byte) {
  if (byte > (texcoord_flag | piece_flag)) gltf::refuse_document("the table of levels", "has unknown flags");
  return {(byte & texcoord_flag) != 0, (byte & piece_flag) != 0};
}
Flags flags_of(const LevelTable& table) { return {table.has_texcoords, table.has_pieces}; }

std::string place_of(size_t level) {
  return level == 0 ? "the base's row" : "the row of level " + std::to_string(level);
}

bool are_bounds(const PieceBounds& bounds) {
  const auto is_within = [](float number, float least, float most) { return number >= least && number <= most; };
  const auto are_within = [&](Vec3f v, float most) {
    return is_within(v.x, -most, most) && is_within(v.y, -most, most) && is_within(v.z, -most, most);
  };
  constexpr float most = std::numeric_limits<float>::max();
  return is_within(bounds.largest_move, 0, most) && are_within(bounds.centre, most) &&
         is_within(bounds.radius, 0, most) && are_within(bounds.axis, 1) && is_within(bounds.least_cosine, -1, 1);
}

/// Writer of little-endian numbers.
class TableWriter {
 public:
  void put_byte(uint8_t byte) { bytes_ += static_cast<char>(byte); }
  void put(uint32_t number) {
    for (unsigned i = 0; i < 4; ++i) put_byte(static_cast<uint8_t>(number >> (8 * i) & 0xFF));
  }
  void put_step(float step, bool may_be_zero) {
    if (!(step > 0 || (may_be_zero && step == 0)) || step > coordinate_limit)
      throw std::invalid_argument("write_table: no step");
    put(std::bit_cast<uint32_t>(step));
  }
  void put(const DetailReach& reach) {
    put_distance(reach.rms);
    put_distance(reach.largest);
  }
  void put(const PieceBounds& bounds) {
    if (!are_bounds(bounds)) throw std::invalid_argument("write_table: no bounds");
    for (const float number : {bounds.largest_move, bounds.centre.x, bounds.centre.y, bounds.centre.z, bounds.radius,
                               bounds.axis.x, bounds.axis.y, bounds.axis.z, bounds.least_cosine})
      put(std::bit_cast<uint32_t>(number));
  }
  [[nodiscard]] std::string take() && { return std::move(bytes_); }

 private:
  void put_distance(double distance) {
    auto rounded = static_cast<float>(distance);
    if (rounded < distance) rounded = std::nextafter(rounded, std::numeric_limits<float>::infinity());
    if (!(distance >= 0) || !std::isfinite(rounded)) throw std::invalid_argument("write_table: no distance");
    put(std::bit_cast<uint32_t>(rounded));
  }

  std::string bytes_;
};

/// Reader of little-endian numbers from the begin of bytes, which must suffice.
class TableReader {
 public:
  explicit TableReader(std::string_view bytes) : bytes_(bytes) {}

  uint8_t byte() {
    const auto first = static_cast<uint8_t>(bytes_.front());
    bytes_.remove_prefix(1);
    return first;
  }
  uint32_t number() {
    uint32_t number = 0;
    for (unsigned i = 0; i < 4; ++i) number |= uint32_t{byte()} << (8 * i);
    return number;
  }
  float step(const std::string& where, bool may_be_zero) {
    const auto step = std::bit_cast<float>(number());
    if (!(step > 0 || (may_be_zero && step == 0)) || step > coordinate_limit)
      gltf::refuse_document(where, "has a step that is not above 0 and at most 1e18");
    return step;
  }
  DetailReach reach(const std::string& where) {
    const double rms = distance(where);
    return {rms, distance(where)};
  }
  PieceBounds bounds(const std::string& where) {
    const auto next = [&] { return std::bit_cast<float>(number()); };
    PieceBounds bounds;
    for (float* number : {&bounds.largest_move, &bounds.centre.x, &bounds.centre.y, &bounds.centre.z, &bounds.radius,
                          &bounds.axis.x, &bounds.axis.y, &bounds.axis.z, &bounds.least_cosine})
      *number = next();
    if (!are_bounds(bounds)) gltf::refuse_document(where, "has a bound that is not finite or out of its range");
    return bounds;
  }

 private:
  double distance(const std::string& where) {
    const auto distance = std::bit_cast<float>(number());
    if (!(distance >= 0) || !std::isfinite(distance))
      gltf::refuse_document(where, "has a distance that is negative or not finite");
    return distance;
  }

  std::string_view bytes_;
};

}  // namespace

uint64_t LevelTable::size() const {
  const Flags flags = flags_of(*this);
  return std::accumulate(rows.begin(), rows.end(), least_table_bytes + rows.size() * flags.row(),
                         [&](uint64_t sum, const LevelRow& row) { return sum + row.pieces.size() * flags.piece(); });
}

uint64_t LevelTable::total() const {
  return std::accumulate(rows.begin(), rows.end(), size() + curve_bytes,
                         [](uint64_t sum, const LevelRow& row) { return sum + row.bytes + row.texcoord_bytes; });
}

uint64_t size_of_rows(std::string_view begin) {
  TableReader reader(begin);
  const uint8_t levels = reader.byte();
  const Flags flags = flags_of(reader.byte());
  if (levels > most_detail_levels)
    gltf::refuse_document("the table of levels", "has " + std::to_string(levels) + " of them; at most " +
                                                     std::to_string(most_detail_levels) + " are allowed");
  return least_table_bytes + levels * flags.row();
}

uint64_t size_of_table(std::string_view rows) {
  const Flags flags = flags_of(static_cast<uint8_t>(rows[1]));
  uint64_t size = rows.size();
  if (!flags.has_pieces) return size;
  for (size_t l = 0; l < static_cast<uint8_t>(rows[0]); ++l) {
    const uint32_t count =
        TableReader(rows.substr(least_table_bytes + (l + 1) * flags.row() - piece_count_bytes)).number();
    if (count == 0 || count > most_detail_pieces)
      gltf::refuse_document(place_of(l + 1), "has " + std::to_string(count) + " pieces; 1 to " +
                                                 std::to_string(most_detail_pieces) + " are allowed");
    if (count > 1) size += count * flags.piece();
  }
  return size;
}

std::string write_table(const LevelTable& table) {
  const Flags flags = flags_of(table);
  TableWriter writer;
  writer.put_byte(static_cast<uint8_t>(table.rows.size()));
  writer.put_byte(flags.byte());
  writer.put(table.edges);
  writer.put(table.curve_bytes);
  writer.put(table.base_reach);
  for (const LevelRow& row : table.rows) {
    writer.put_step(row.step, false);
    writer.put(row.reach);
    writer.put(row.bytes);
    if (flags.has_texcoords) {
      writer.put_step(row.texcoord_step, true);
      writer.put(row.texcoord_bytes);
    }
    if (flags.has_pieces) writer.put(static_cast<uint32_t>(std::max<size_t>(1, row.pieces.size())));
  }
  for (const LevelRow& row : table.rows)
    for (const DetailPiece& piece : row.pieces) {
      writer.put(piece.bytes);
      if (flags.has_texcoords) writer.put(piece.texcoord_bytes);
      writer.put(piece.bounds);
    }
  return std::move(writer).take();
}

namespace {

void read_pieces(TableReader& reader, bool has_texcoords, const std::string& where, LevelRow& row) {
  uint64_t bytes = 0, texcoord_bytes = 0;
  for (DetailPiece& piece : row.pieces) {
    bytes += piece.bytes = reader.number();
    if (has_texcoords) texcoord_bytes += piece.texcoord_bytes = reader.number();
    piece.bounds = reader.bounds(where);
  }
  if (bytes != row.bytes || texcoord_bytes != row.texcoord_bytes)
    gltf::refuse_document(where, "has other bytes than its pieces together");
}

}  // namespace

LevelTable read_table(std::string_view bytes) {
  TableReader reader(bytes);
  LevelTable table;
  table.rows.resize(reader.byte());
  const Flags flags = flags_of(reader.byte());
  table.has_texcoords = flags.has_texcoords;
  table.has_pieces = flags.has_pieces;
  table.edges = reader.number();
  table.curve_bytes = reader.number();
  table.base_reach = reader.reach(place_of(0));
  for (size_t l = 0; l < table.rows.size(); ++l) {
    LevelRow& row = table.rows[l];
    const std::string where = place_of(l + 1);
    row.step = reader.step(where, false);
    row.reach = reader.reach(where);
    row.bytes = reader.number();
    if (flags.has_texcoords) {
      row.texcoord_step = reader.step(where, true);
      row.texcoord_bytes = reader.number();
      if (row.texcoord_step == 0 && row.texcoord_bytes > 0)
        gltf::refuse_document(where, "has texture coordinates without a step");
    }
    if (const uint32_t count = flags.has_pieces ? reader.number() : 1; count > 1) row.pieces.resize(count);
  }
  for (size_t l = 0; l < table.rows.size(); ++l)
    if (!table.rows[l].pieces.empty()) read_pieces(reader, flags.has_texcoords, place_of(l + 1), table.rows[l]);
  return table;
}

}  // namespace papilio::proto::detail
