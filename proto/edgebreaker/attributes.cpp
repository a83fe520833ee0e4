#include "proto/edgebreaker/attributes.h"

#include <draco/attributes/point_attribute.h>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_geometric_normal_encoder.h>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_tex_coords_portable_encoder.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_delta_encoder.h>
#include <draco/core/bit_utils.h>
#include <draco/core/varint_encoding.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <optional>
#include <vector>

#include "proto/edgebreaker/attribute_quantizer.h"
#include "proto/edgebreaker/predictions.h"
#include "proto/edgebreaker/speeds.h"

namespace papilio::proto::edgebreaker {
namespace {

constexpr uint32_t texture_components = 2;

/// Writes integers without entropy coding and without predictions, for values too large for libdraco's entropy coder.
void write_unpredicted(const Integers& integers, draco::EncoderBuffer& out) {
  std::vector<uint32_t> symbols(integers.values.size());
  draco::ConvertSignedIntsToSymbols(integers.values.data(), static_cast<int>(symbols.size()), symbols.data());
  uint32_t bits = 0;
  for (const uint32_t symbol : symbols) bits |= symbol;
  const size_t bytes = std::max<size_t>(1, (std::bit_width(bits) + 7U) / 8U);
  out.Encode(static_cast<int8_t>(draco::PREDICTION_NONE));
  out.Encode(uint8_t{0});  // not entropy coded
  out.Encode(static_cast<uint8_t>(bytes));
  for (const uint32_t symbol : symbols) out.Encode(&symbol, bytes);
}

/// Writer of the values of one attribute.
class ValueWriter {
 public:
  ValueWriter(const OutputAttribute& attribute, const CornerMesh& mesh, const Buffer<uint32_t>& corners, int speed,
              Poller& poller)
      : attribute_(attribute), surface_(mesh, corners, poller), speed_(speed), poller_(poller) {}

  void run(const WrittenSurface& written, draco::EncoderBuffer& out) {
    if (attribute_.coding == Coding::as_is) {
      write_raw(written, out);
      return;
    }
    const Integers integers = to_integers(written);
    if (attribute_.is_too_large) {
      write_unpredicted(integers, out);
      return;
    }
    if (needs_positions()) set_positions(written);
    if (attribute_.coding == Coding::octahedral) {
      if (write(integers, *octahedral_predictor(), out)) return;
      draco::PredictionSchemeDeltaEncoder<int32_t, Octahedron> difference(nullptr, octahedron());
      (void)write(integers, difference, out);
    } else if (!write(integers, *predictor(written.points), out)) {
      (void)write(integers, *difference_predictor(), out);
    }
  }

 private:
  [[nodiscard]] const char* bytes_at(const WrittenSurface& written, draco::CornerIndex corner) const {
    const StoredValues& values = attribute_.values;
    return values.bytes.data() + values.value[written.corner_point[corner.value()]] * stride_;
  }

  void write_raw(const WrittenSurface& written, draco::EncoderBuffer& out) {
    for (draco::CornerIndex c : surface_.corners()) {
      poller_.step();
      out.Encode(bytes_at(written, c), stride_);
    }
  }

  [[nodiscard]] Integers to_integers(const WrittenSurface& written) {
    AttributeQuantizer quantizer(attribute_);
    Integers integers{quantizer.components(), {}};
    integers.values.reserve(surface_.corners().size() * integers.components);
    for (draco::CornerIndex c : surface_.corners()) {
      poller_.step();
      quantizer.append(bytes_at(written, c), integers.values);
    }
    return integers;
  }

  [[nodiscard]] bool is_texture() const {
    return attribute_.coding == Coding::grid && attribute_.format.kind == AttributeKind::tex_coord &&
           attribute_.components == texture_components;
  }
  [[nodiscard]] bool needs_positions() const {
    return speed_ < min_position_independent_speed && (attribute_.coding == Coding::octahedral || is_texture());
  }

  void set_positions(const WrittenSurface& written) {
    draco::GeometryAttribute description;
    description.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false, 3 * sizeof(int32_t), 0);
    positions_.emplace(description);
    positions_->Reset(written.positions.size());
    positions_->SetIdentityMapping();
    for (uint32_t v = 0; v < written.positions.size(); ++v)
      positions_->SetAttributeValue(draco::AttributeValueIndex(v), &written.positions[v]);
    vertices_.reserve(surface_.corners().size());
    for (draco::CornerIndex c : surface_.corners()) vertices_.emplace_back(written.mesh.vertex(c.value()));
  }

  [[nodiscard]] std::unique_ptr<Predictor<Wrap>> predictor(uint32_t points) const {
    if (needs_positions())
      return std::make_unique<draco::MeshPredictionSchemeTexCoordsPortableEncoder<int32_t, Wrap, MeshData>>(
          nullptr, Wrap(), surface_.data());
    if (attribute_.format.kind == AttributeKind::normal) return difference_predictor();
    return wrapped_predictor(surface_, speed_, points);
  }
  [[nodiscard]] Octahedron octahedron() const { return Octahedron((1 << attribute_.bits) - 1); }
  [[nodiscard]] std::unique_ptr<Predictor<Octahedron>> octahedral_predictor() const {
    if (needs_positions())
      return std::make_unique<draco::MeshPredictionSchemeGeometricNormalEncoder<int32_t, Octahedron, MeshData>>(
          nullptr, octahedron(), surface_.data());
    return std::make_unique<draco::PredictionSchemeDeltaEncoder<int32_t, Octahedron>>(nullptr, octahedron());
  }

  template <class Transform>
  bool write(const Integers& integers, Predictor<Transform>& predictor, draco::EncoderBuffer& out) {
    if (predictor.GetNumParentAttributes() > 0 && !predictor.SetParentAttribute(&*positions_)) return false;
    return write_predicted(integers, predictor, vertices_, speed_, out);
  }

  const OutputAttribute& attribute_;
  const OrderedSurface surface_;  ///< surface cut open at the attribute's seams
  int speed_;
  Poller& poller_;
  size_t stride_ = size_t{attribute_.components} * draco::DataTypeLength(draco_type(attribute_.format.type));
  std::optional<draco::PointAttribute> positions_;  ///< parent attribute of predictions
  std::vector<draco::PointIndex> vertices_;         ///< [values] vertex of each value; empty without a parent
};

}  // namespace

void write_declaration(const OutputAttribute& attribute, draco::EncoderBuffer& out) {
  out.Encode(static_cast<uint8_t>(draco_type(attribute.format.kind)));
  out.Encode(static_cast<uint8_t>(draco_type(attribute.format.type)));
  out.Encode(static_cast<uint8_t>(attribute.components));
  out.Encode(static_cast<uint8_t>(attribute.format.normalized ? 1 : 0));
  draco::EncodeVarint<uint32_t>(attribute.format.id, &out);
}

void write_values(const OutputAttribute& attribute, const Seams& seams, const WrittenSurface& written, int speed,
                  Poller& poller, draco::EncoderBuffer& out) {
  if (seams.empty()) {
    ValueWriter(attribute, written.mesh, written.order.corners, speed, poller).run(written, out);
    return;
  }
  const CornerMesh open = cut_open(written.mesh, seams);
  const VertexOrder order = order_vertices(open, written.starts, poller);
  ValueWriter(attribute, open, order.corners, speed, poller).run(written, out);
}

void write_quantization(const OutputAttribute& attribute, draco::EncoderBuffer& out) {
  if (attribute.coding == Coding::as_is || attribute.coding == Coding::integers) return;
  if (attribute.coding == Coding::grid) {
    for (const float origin : attribute.grid.origin) out.Encode(origin);
    out.Encode(attribute.grid.range);
  }
  out.Encode(static_cast<uint8_t>(attribute.bits));
}

}  // namespace papilio::proto::edgebreaker
