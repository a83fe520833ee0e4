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
#include "proto/freed_memory.h"

namespace papilio::proto::edgebreaker {
namespace {

/// Writer of one stream. Positions are quantized to the box's grid, or exact if `box` is null.
class StreamWriter {
 public:
  StreamWriter(const Mesh& mesh, const QuantizationBox* box, const OutputOptions& options, uint32_t position_id,
               std::span<const OutputAttribute> attributes, const std::function<void()>& poll)
      : mesh_(mesh),
        box_(box),
        options_(options),
        position_id_(position_id),
        attributes_(attributes),
        poller_(poll),
        surface_(manifold_surface(mesh.topology)),
        single_connectivity_(is_single_connectivity()) {}

  /// Allows the writer to free arrays of the attributes and of the mesh, whose positions must be quantized.
  void consume(Mesh& mesh, std::span<OutputAttribute> attributes) {
    constexpr uint32_t large = 1 << 15;  // faces
    consumed_ = &mesh;
    consumed_attributes_ = attributes;
    for (Buffer<uint32_t> Topology::*array :
         {&Topology::origin, &Topology::twin, &Topology::edge, &Topology::half_edge})
      mesh.topology.*array = {};
    mesh.topology.kind = {};
    gives_back_ = surface_.mesh.face_count() >= large;
    give_back();
  }

  std::string run() {
    write();
    return {out_.data(), out_.size()};
  }

  /// Returns the stream of a mesh with quantized positions, and a description of the decoded mesh.
  WrittenStream run_and_describe() {
    write();
    return {{out_.data(), out_.size()}, decoded_points_, surface_.mesh.face_count(), decoded_box_};
  }

 private:
  void write() {
    poller_.call();
    std::vector<Seams> seams;
    seams.reserve(attributes_.size());
    for (const OutputAttribute& attribute : attributes_)
      seams.push_back(find_seams(surface_.mesh, mesh_.attributes.point, attribute));
    const std::span<const Seams> separate = single_connectivity_ ? std::span<const Seams>() : seams;
    write_header();
    const Buffer<uint32_t> starts = write_connectivity(surface_.mesh, traversal(), separate, poller_, out_);
    write_encoders(separate);
    write_declarations();
    if (consumed_ != nullptr) decoded_points_ = decoded_points(surface_.mesh, separate);
    write_all_values(seams, starts);
    poller_.call();
  }

  [[nodiscard]] Traversal traversal() const {
    const bool is_standard =
        options_.speed >= min_standard_traversal_speed || surface_.mesh.face_count() < min_valence_faces;
    return is_standard ? Traversal::standard : Traversal::valence;
  }
  /// Returns whether one encoder writes all attributes with the connectivity of the positions. Draco does so at high
  /// speeds if no attribute has seams.
  [[nodiscard]] bool is_single_connectivity() const {
    return options_.speed >= min_single_connectivity_speed && attributes_.empty();
  }
  [[nodiscard]] bool is_by_prediction_degree() const { return options_.speed <= max_prediction_degree_speed; }
  /// Returns the number of points of the mesh in libdraco.
  [[nodiscard]] uint32_t point_count() const {
    return !attributes_.empty() ? mesh_.attributes.point_count : mesh_.topology.vertex_count;
  }

  /// Returns freed memory of a large mesh to the system.
  void give_back() const {
    if (gives_back_) give_back_freed();
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

  /// Writes each encoder: the attribute whose seams it follows, whether there are seams, and its traversal.
  void write_encoders(std::span<const Seams> separate) {
    out_.Encode(static_cast<uint8_t>(1 + separate.size()));
    constexpr uint8_t depth_first = 0;
    constexpr uint8_t prediction_degree = 1;
    const uint8_t position_traversal = is_by_prediction_degree() ? prediction_degree : depth_first;
    for (const uint8_t byte : {uint8_t{255}, uint8_t{0}, position_traversal}) out_.Encode(byte);
    for (size_t a = 0; a < separate.size(); ++a) {
      out_.Encode(static_cast<int8_t>(a));
      out_.Encode(static_cast<uint8_t>(separate[a].empty() ? 0 : 1));
      out_.Encode(depth_first);
    }
  }

  void write_declarations() {
    draco::EncodeVarint<uint32_t>(static_cast<uint32_t>(single_connectivity_ ? 1 + attributes_.size() : 1), &out_);
    for (const uint8_t byte : {0, 9, 3, 0}) out_.Encode(byte);  // position, float32, three components, not normalized
    draco::EncodeVarint<uint32_t>(position_id_, &out_);
    if (single_connectivity_)
      for (const OutputAttribute& attribute : attributes_) write_declaration(attribute, out_);
    out_.Encode(static_cast<uint8_t>(box_ != nullptr ? Coding::grid : Coding::as_is));
    for (const OutputAttribute& attribute : attributes_) {
      if (!single_connectivity_) {
        draco::EncodeVarint<uint32_t>(1, &out_);
        write_declaration(attribute, out_);
      }
      out_.Encode(static_cast<uint8_t>(attribute.coding));
    }
  }

  void write_all_values(std::span<const Seams> seams, const Buffer<uint32_t>& starts) {
    const CornerMesh& mesh = surface_.mesh;
    VertexOrder order;
    if (!is_by_prediction_degree() || !attributes_.empty()) order = order_vertices(mesh, starts, poller_);
    Buffer<GridPoint> positions;
    if (box_ != nullptr) positions = to_grid(mesh_.positions, surface_, *box_, options_.position_bits);
    if (consumed_ != nullptr) {
      consumed_->positions = {};
      decoded_box_ = decoded_box(positions, *box_, options_.position_bits);
    }
    write_position_values(order, positions, starts);
    if (!single_connectivity_) write_position_quantization();
    for (size_t a = 0; a < attributes_.size(); ++a) {
      write_values(attributes_[a], seams[a], {mesh, mesh_.attributes.point, starts, order, positions, point_count()},
                   options_.speed, poller_, out_);
      if (!single_connectivity_) write_quantization(attributes_[a], out_);
      if (consumed_ != nullptr) consumed_attributes_[a].values = {};
      give_back();
    }
    if (!single_connectivity_) return;
    write_position_quantization();
    for (const OutputAttribute& attribute : attributes_) write_quantization(attribute, out_);
  }

  void write_position_values(const VertexOrder& order, const Buffer<GridPoint>& positions,
                             const Buffer<uint32_t>& starts) {
    const CornerMesh& mesh = surface_.mesh;
    if (box_ == nullptr) {
      write_positions_exactly(mesh_.positions, surface_, order.corners, poller_, out_);
    } else if (options_.speed < min_single_parallelogram_speed) {
      write_positions_multi_parallelogram(
          mesh, is_by_prediction_degree() ? order_by_prediction_degree(mesh, starts, poller_) : order.corners,
          positions, options_.speed, point_count(), poller_, out_);
    } else {
      const bool is_by_difference = options_.speed >= min_difference_speed;
      write_positions(mesh, order, positions, is_by_difference ? Prediction::difference : Prediction::parallelogram,
                      10 - options_.speed, poller_, out_);
    }
  }

  void write_position_quantization() {
    if (box_ != nullptr) write_grid(*box_, options_.position_bits, out_);
  }

  const Mesh& mesh_;
  const QuantizationBox* box_;
  const OutputOptions& options_;
  uint32_t position_id_;
  std::span<const OutputAttribute> attributes_;
  Poller poller_;
  Surface surface_;
  bool single_connectivity_;
  draco::EncoderBuffer out_;
  Mesh* consumed_ = nullptr;  ///< null: the mesh is only read
  bool gives_back_ = false;
  uint32_t decoded_points_ = 0;
  Box decoded_box_{};
  std::span<OutputAttribute> consumed_attributes_{};
};

}  // namespace

std::string write(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options, uint32_t position_id,
                  std::span<const OutputAttribute> attributes, const std::function<void()>& poll) {
  return StreamWriter(mesh, &box, options, position_id, attributes, poll).run();
}

WrittenStream write_and_free(Mesh mesh, const QuantizationBox& box, const OutputOptions& options, uint32_t position_id,
                             std::vector<OutputAttribute> attributes, const std::function<void()>& poll) {
  StreamWriter writer(mesh, &box, options, position_id, attributes, poll);
  writer.consume(mesh, attributes);
  return writer.run_and_describe();
}

std::string write_exact(const Mesh& mesh, uint32_t position_id, std::span<const OutputAttribute> attributes) {
  constexpr OutputOptions options{.speed = min_standard_traversal_speed};
  return StreamWriter(mesh, nullptr, options, position_id, attributes, {}).run();
}

}  // namespace papilio::proto::edgebreaker
