#include "proto/edgebreaker/writer.h"

#include <draco/core/varint_encoding.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "proto/edgebreaker/attributes.h"
#include "proto/edgebreaker/connectivity.h"
#include "proto/edgebreaker/positions.h"
#include "proto/edgebreaker/seams.h"

namespace papilio::proto::edgebreaker {
namespace {

// What Draco makes of its speed.
constexpr int slowest = 2;         ///< below, it chooses among parallelograms
constexpr int standard_speed = 5;  ///< from here on, or for few faces, symbols are written as bits
constexpr int single_connectivity_speed = 6;
constexpr int difference_speed = 8;  ///< from here on, no parallelograms
constexpr uint32_t few_faces = 1000;

/// Whether some pair of vertices has more than one edge, or more than two faces at one; or boundaries touch at a
/// vertex.
bool is_seen_otherwise(const CornerMesh& mesh) {
  if (mesh.has_faces_folded_together()) return true;
  std::vector<std::pair<uint32_t, uint32_t>> open;
  std::vector<uint32_t> starts;
  for (uint32_t c : mesh.at_boundary()) {
    const uint32_t from = mesh.vertex(CornerMesh::next(c));
    const uint32_t to = mesh.vertex(CornerMesh::previous(c));
    open.emplace_back(std::minmax(from, to));
    starts.push_back(from);
  }
  const auto has_twice = [](auto& list) {
    std::ranges::sort(list);
    return std::ranges::adjacent_find(list) != list.end();
  };
  return has_twice(open) || has_twice(starts);
}

void write_header(Traversal traversal, draco::EncoderBuffer& out) {
  out.Encode("DRACO", 5);
  for (const uint8_t byte : {2, 2, 1, 1}) out.Encode(byte);  // version 2.2, a mesh, edgebreaker
  out.Encode(uint16_t{0});                                   // no metadata
  out.Encode(static_cast<uint8_t>(traversal));
}

/// Whether the attributes are written with the connectivity of positions, by one encoder: what Draco does at high
/// speeds where it need not cut the surface open.
bool is_single_connectivity(std::span<const OutputAttribute> attributes, int speed) {
  return speed >= single_connectivity_speed && std::ranges::all_of(attributes, &OutputAttribute::is_of_vertices);
}

/// Each encoder: with which attribute's seams, and whether it has any.
void write_encoders(std::span<const Seams> own, draco::EncoderBuffer& out) {
  out.Encode(static_cast<uint8_t>(1 + own.size()));
  constexpr uint8_t depth_first = 0;
  for (const uint8_t byte : {uint8_t{255}, uint8_t{0}, depth_first}) out.Encode(byte);  // the connectivity of positions
  for (size_t a = 0; a < own.size(); ++a) {
    out.Encode(static_cast<int8_t>(a));
    out.Encode(static_cast<uint8_t>(own[a].empty() ? 0 : 1));
    out.Encode(depth_first);
  }
}

void describe_positions(uint32_t position_id, draco::EncoderBuffer& out) {
  for (const uint8_t byte : {0, 9, 3, 0}) out.Encode(byte);  // position, float32, three components, as they are
  draco::EncodeVarint<uint32_t>(position_id, &out);
}

void write_descriptions(uint32_t position_id, std::span<const OutputAttribute> attributes, bool in_one,
                        draco::EncoderBuffer& out) {
  const auto encoders = static_cast<uint32_t>(in_one ? 1 + attributes.size() : 1);
  draco::EncodeVarint<uint32_t>(encoders, &out);
  describe_positions(position_id, out);
  if (in_one)
    for (const OutputAttribute& attribute : attributes) describe(attribute, out);
  out.Encode(uint8_t{2});  // on a grid
  for (const OutputAttribute& attribute : attributes) {
    if (!in_one) {
      draco::EncodeVarint<uint32_t>(1, &out);
      describe(attribute, out);
    }
    out.Encode(coding_byte(attribute));
  }
}

}  // namespace

std::optional<std::string> write(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                                 uint32_t position_id, std::span<const OutputAttribute> attributes) {
  if (options.speed < slowest || !mesh.topology.pinched.empty() || !std::ranges::all_of(attributes, can_write))
    return std::nullopt;
  CornerMesh corners(mesh.topology);
  if (is_seen_otherwise(corners)) return std::nullopt;
  const bool is_standard = options.speed >= standard_speed || mesh.topology.face_count() < few_faces;
  const Traversal traversal = is_standard ? Traversal::standard : Traversal::valence;
  const Prediction prediction = options.speed >= difference_speed ? Prediction::difference : Prediction::parallelogram;
  std::vector<Seams> seams;
  for (const OutputAttribute& attribute : attributes)
    seams.push_back(find_seams(corners, mesh.topology, mesh.attributes.point, attribute));
  const bool in_one = is_single_connectivity(attributes, options.speed);
  const std::span<const Seams> own = in_one ? std::span<const Seams>() : seams;

  draco::EncoderBuffer out;
  write_header(traversal, out);
  const Array<uint32_t> starts = write_connectivity(corners, traversal, own, out);
  const VertexOrder order = order_vertices(corners, starts);
  write_encoders(own, out);
  write_descriptions(position_id, attributes, in_one, out);

  const Array<GridPoint> positions = to_grid(mesh.positions, box, options.position_bits);
  write_positions(corners, order, positions, prediction, 10 - options.speed, out);
  if (!in_one) write_grid(box, options.position_bits, out);
  for (size_t a = 0; a < attributes.size(); ++a) {
    if (!write_values(attributes[a], seams[a], {corners, starts, order, positions}, options.speed, out))
      return std::nullopt;
    if (!in_one) write_coding(attributes[a], out);
  }
  if (in_one) {
    write_grid(box, options.position_bits, out);
    for (const OutputAttribute& attribute : attributes) write_coding(attribute, out);
  }
  return std::string(out.data(), out.size());
}

}  // namespace papilio::proto::edgebreaker
