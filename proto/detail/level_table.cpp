#include "proto/detail/level_table.h"

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
constexpr uint8_t texcoord_flag = 1;

uint64_t table_size(uint64_t levels, bool has_texcoords) {
  return least_table_bytes + levels * (row_bytes + (has_texcoords ? texcoord_row_bytes : 0));
}

std::string place_of(size_t level) {
  return level == 0 ? "the base's row" : "the row of level " + std::to_string(level);
}

/// Appends numbers, little-endian.
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

/// Takes numbers from the begin of bytes, of which there are enough.
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

uint64_t LevelTable::size() const { return table_size(rows.size(), has_texcoords); }

uint64_t LevelTable::total() const {
  return std::accumulate(rows.begin(), rows.end(), size() + curve_bytes,
                         [](uint64_t sum, const LevelRow& row) { return sum + row.bytes + row.texcoord_bytes; });
}

uint64_t size_of_table(std::string_view begin) {
  TableReader reader(begin);
  const uint8_t levels = reader.byte();
  const uint8_t flags = reader.byte();
  if (levels > most_detail_levels)
    gltf::refuse_document("the table of levels", "has " + std::to_string(levels) + " of them; at most " +
                                                     std::to_string(most_detail_levels) + " are allowed");
  if (flags > texcoord_flag) gltf::refuse_document("the table of levels", "has unknown flags");
  return table_size(levels, flags == texcoord_flag);
}

std::string write_table(const LevelTable& table) {
  TableWriter writer;
  writer.put_byte(static_cast<uint8_t>(table.rows.size()));
  writer.put_byte(table.has_texcoords ? texcoord_flag : 0);
  writer.put(table.edges);
  writer.put(table.curve_bytes);
  writer.put(table.base_reach);
  for (const LevelRow& row : table.rows) {
    writer.put_step(row.step, false);
    writer.put(row.reach);
    writer.put(row.bytes);
    if (!table.has_texcoords) continue;
    writer.put_step(row.texcoord_step, true);
    writer.put(row.texcoord_bytes);
  }
  return std::move(writer).take();
}

LevelTable read_table(std::string_view bytes) {
  TableReader reader(bytes);
  LevelTable table;
  table.rows.resize(reader.byte());
  table.has_texcoords = reader.byte() == texcoord_flag;
  table.edges = reader.number();
  table.curve_bytes = reader.number();
  table.base_reach = reader.reach(place_of(0));
  for (size_t l = 0; l < table.rows.size(); ++l) {
    LevelRow& row = table.rows[l];
    const std::string where = place_of(l + 1);
    row.step = reader.step(where, false);
    row.reach = reader.reach(where);
    row.bytes = reader.number();
    if (!table.has_texcoords) continue;
    row.texcoord_step = reader.step(where, true);
    row.texcoord_bytes = reader.number();
    if (row.texcoord_step == 0 && row.texcoord_bytes > 0)
      gltf::refuse_document(where, "has texture coordinates without a step");
  }
  return table;
}

}  // namespace papilio::proto::detail
