#include "proto/edgebreaker/writer.h"

#include <draco/compression/config/compression_shared.h>
#include <draco/core/varint_encoding.h>
#include <draco/metadata/geometry_metadata.h>
#include <draco/metadata/metadata_encoder.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "proto/draco_attributes.h"
#include "proto/edgebreaker/attributes.h"
#include "proto/edgebreaker/connectivity.h"
#include "proto/edgebreaker/positions.h"
#include "proto/edgebreaker/seams.h"
#include "proto/edgebreaker/speeds.h"
#include "proto/edgebreaker/surface.h"

namespace papilio::proto::edgebreaker {
namespace {

/// A stream on its way. Positions are on the box's grid, or exact where there is no box.
class StreamWriter {
 public:
  StreamWriter(const Mesh& mesh, const QuantizationBox* box, const OutputOptions& options, uint32_t position_id,
               std::span<const OutputAttribute> attributes, const std::function<void()>& poll)
      : mesh_(mesh),
        box_(box),
        options_(options),
        position_id_(position_id),
        attributes_(attributes),
        pace_(poll),
        surface_(manifold_surface(mesh.topology)),
        in_one_(is_single_connectivity()) {}

  std::string run() {
    pace_.call();
    std::vector<Seams> seams;
    for (const OutputAttribute& attribute : attributes_)
      seams.push_back(find_seams(surface_.mesh, mesh_.topology, mesh_.attributes.point, attribute));
    const std::span<const Seams> own = in_one_ ? std::span<const Seams>() : seams;
    write_header();
    const Array<uint32_t> starts = write_connectivity(surface_.mesh, traversal(), own, pace_, out_);
    write_encoders(own);
    write_descriptions();
    write_all_values(seams, starts);
    pace_.call();
    return {out_.data(), out_.size()};
  }

 private:
  [[nodiscard]] Traversal traversal() const {
    const bool is_standard =
        options_.speed >= min_standard_traversal_speed || mesh_.topology.face_count() < min_valence_faces;
    return is_standard ? Traversal::standard : Traversal::valence;
  }
  /// Whether the attributes are written with the connectivity of positions, by one encoder: what Draco does at high
  /// speeds where it need not cut the surface open.
  [[nodiscard]] bool is_single_connectivity() const {
    return options_.speed >= min_single_connectivity_speed &&
           std::ranges::all_of(attributes_, &OutputAttribute::is_of_vertices);
  }
  [[nodiscard]] bool is_by_prediction_degree() const { return options_.speed <= max_prediction_degree_speed; }
  /// How many points libdraco would have.
  [[nodiscard]] uint32_t point_count() const {
    const bool has_points = !std::ranges::all_of(attributes_, &OutputAttribute::is_of_vertices);
    return has_points ? mesh_.attributes.point_count : mesh_.topology.vertex_count;
  }

  void write_header() {
    const draco::GeometryMetadata names = names_of_attributes();
    const bool has_names = !names.attribute_metadatas().empty();
    out_.Encode("DRACO", 5);
    for (const uint8_t byte : {2, 2, 1, 1}) out_.Encode(byte);  // version 2.2, a mesh, edgebreaker
    out_.Encode(static_cast<uint16_t>(has_names ? METADATA_FLAG_MASK : 0));
    if (has_names) draco::MetadataEncoder().EncodeGeometryMetadata(&out_, &names);
    out_.Encode(static_cast<uint8_t>(traversal()));
  }

  [[nodiscard]] draco::GeometryMetadata names_of_attributes() const {
    draco::GeometryMetadata names;
    for (const OutputAttribute& attribute : attributes_) {
      if (attribute.format.name.empty()) continue;
      auto metadata = std::make_unique<draco::AttributeMetadata>();
      metadata->set_att_unique_id(attribute.format.id);
      metadata->AddEntryString(name_entry, attribute.format.name);
      names.AddAttributeMetadata(std::move(metadata));
    }
    return names;
  }

  /// Each encoder: with which attribute's seams, and whether it has any.
  void write_encoders(std::span<const Seams> own) {
    out_.Encode(static_cast<uint8_t>(1 + own.size()));
    constexpr uint8_t depth_first = 0;
    constexpr uint8_t prediction_degree = 1;
    const uint8_t of_positions = is_by_prediction_degree() ? prediction_degree : depth_first;
    for (const uint8_t byte : {uint8_t{255}, uint8_t{0}, of_positions}) out_.Encode(byte);
    for (size_t a = 0; a < own.size(); ++a) {
      out_.Encode(static_cast<int8_t>(a));
      out_.Encode(static_cast<uint8_t>(own[a].empty() ? 0 : 1));
      out_.Encode(depth_first);
    }
  }

  void write_descriptions() {
    draco::EncodeVarint<uint32_t>(static_cast<uint32_t>(in_one_ ? 1 + attributes_.size() : 1), &out_);
    for (const uint8_t byte : {0, 9, 3, 0}) out_.Encode(byte);  // position, float32, three components, as they are
    draco::EncodeVarint<uint32_t>(position_id_, &out_);
    if (in_one_)
      for (const OutputAttribute& attribute : attributes_) describe(attribute, out_);
    out_.Encode(static_cast<uint8_t>(box_ != nullptr ? Coding::grid : Coding::as_is));
    for (const OutputAttribute& attribute : attributes_) {
      if (!in_one_) {
        draco::EncodeVarint<uint32_t>(1, &out_);
        describe(attribute, out_);
      }
      out_.Encode(static_cast<uint8_t>(attribute.coding));
    }
  }

  void write_all_values(std::span<const Seams> seams, const Array<uint32_t>& starts) {
    const CornerMesh& mesh = surface_.mesh;
    VertexOrder order;
    if (!is_by_prediction_degree() || !attributes_.empty()) order = order_vertices(mesh, starts, pace_);
    Array<GridPoint> positions;
    if (box_ != nullptr) positions = to_grid(mesh_.positions, surface_, *box_, options_.position_bits);
    write_position_values(order, positions, starts);
    if (!in_one_) write_position_coding();
    for (size_t a = 0; a < attributes_.size(); ++a) {
      write_values(attributes_[a], seams[a], {mesh, starts, order, positions, point_count()}, options_.speed, pace_,
                   out_);
      if (!in_one_) write_coding(attributes_[a], out_);
    }
    if (!in_one_) return;
    write_position_coding();
    for (const OutputAttribute& attribute : attributes_) write_coding(attribute, out_);
  }

  void write_position_values(const VertexOrder& order, const Array<GridPoint>& positions,
                             const Array<uint32_t>& starts) {
    const CornerMesh& mesh = surface_.mesh;
    if (box_ == nullptr) {
      write_positions_exactly(mesh_.positions, surface_, order.corners, pace_, out_);
    } else if (options_.speed < min_single_parallelogram_speed) {
      write_positions_multi_parallelogram(
          mesh, is_by_prediction_degree() ? order_by_prediction_degree(mesh, starts, pace_) : order.corners, positions,
          options_.speed, point_count(), pace_, out_);
    } else {
      const bool is_by_difference = options_.speed >= min_difference_speed;
      write_positions(mesh, order, positions, is_by_difference ? Prediction::difference : Prediction::parallelogram,
                      10 - options_.speed, pace_, out_);
    }
  }

  void write_position_coding() {
    if (box_ != nullptr) write_grid(*box_, options_.position_bits, out_);
  }

  const Mesh& mesh_;
  const QuantizationBox* box_;
  const OutputOptions& options_;
  uint32_t position_id_;
  std::span<const OutputAttribute> attributes_;
  Pace pace_;
  Surface surface_;
  bool in_one_;
  draco::EncoderBuffer out_;
};

}  // namespace

std::string write(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options, uint32_t position_id,
                  std::span<const OutputAttribute> attributes, const std::function<void()>& poll) {
  return StreamWriter(mesh, &box, options, position_id, attributes, poll).run();
}

std::string write_exact(const Mesh& mesh, uint32_t position_id, std::span<const OutputAttribute> attributes) {
  constexpr OutputOptions options{.speed = min_standard_traversal_speed};
  return StreamWriter(mesh, nullptr, options, position_id, attributes, {}).run();
}

}  // namespace papilio::proto::edgebreaker
