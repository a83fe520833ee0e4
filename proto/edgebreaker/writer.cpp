#include "proto/edgebreaker/writer.h"

#include <draco/core/varint_encoding.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "proto/edgebreaker/connectivity.h"
#include "proto/edgebreaker/positions.h"

namespace papilio::proto::edgebreaker {
namespace {

// What Draco makes of its speed.
constexpr int slowest = 2;           ///< below, it chooses among parallelograms
constexpr int standard_speed = 5;    ///< from here on, or for few faces, symbols are written as bits
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

void write_attribute_header(uint32_t position_id, draco::EncoderBuffer& out) {
  out.Encode(uint8_t{1});                                    // one encoder,
  out.Encode(int8_t{-1});                                    // with the connectivity of positions,
  out.Encode(uint8_t{0});                                    // a value a vertex,
  out.Encode(uint8_t{0});                                    // depth first
  draco::EncodeVarint<uint32_t>(1, &out);                    // one attribute:
  for (const uint8_t byte : {0, 9, 3, 0}) out.Encode(byte);  // position, float32, three components, as they are
  draco::EncodeVarint<uint32_t>(position_id, &out);
  out.Encode(uint8_t{2});  // on a grid
}

}  // namespace

std::optional<std::string> write(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                                 uint32_t position_id) {
  if (options.normals || options.speed < slowest || !mesh.attributes.empty() || !mesh.topology.pinched.empty())
    return std::nullopt;
  const CornerMesh corners(mesh.topology);
  if (is_seen_otherwise(corners)) return std::nullopt;
  const bool is_standard = options.speed >= standard_speed || mesh.topology.face_count() < few_faces;
  const Traversal traversal = is_standard ? Traversal::standard : Traversal::valence;
  const Prediction prediction = options.speed >= difference_speed ? Prediction::difference : Prediction::parallelogram;

  draco::EncoderBuffer out;
  write_header(traversal, out);
  const VertexOrder order = order_vertices(corners, write_connectivity(corners, traversal, out));
  write_attribute_header(position_id, out);
  write_positions(corners, order, mesh.positions, box, options.position_bits, prediction, 10 - options.speed, out);
  return std::string(out.data(), out.size());
}

}  // namespace papilio::proto::edgebreaker
