#include "proto/edgebreaker/attributes.h"

#include <draco/attributes/point_attribute.h>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_data.h>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_geometric_normal_encoder.h>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_parallelogram_encoder.h>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_tex_coords_portable_encoder.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_delta_encoder.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_normal_octahedron_canonicalized_encoding_transform.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_wrap_encoding_transform.h>
#include <draco/core/bit_utils.h>
#include <draco/core/quantization_utils.h>
#include <draco/core/varint_encoding.h>

#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "proto/edgebreaker/symbols.h"

namespace papilio::proto::edgebreaker {
namespace {

// What Draco makes of its speed.
constexpr int geometric_below = 4;   ///< normals and texture coordinates are predicted from positions
constexpr int difference_speed = 8;  ///< from here on, no parallelograms

constexpr uint32_t texture_components = 2;

using Wrap = draco::PredictionSchemeWrapEncodingTransform<int32_t>;
using Octahedron = draco::PredictionSchemeNormalOctahedronCanonicalizedEncodingTransform<int32_t>;

/// A surface as Draco's predictions ask for it.
class CornerTable {
 public:
  explicit CornerTable(const CornerMesh& mesh) : mesh_(mesh) {}
  [[nodiscard]] static draco::CornerIndex Next(draco::CornerIndex c) {
    return draco::CornerIndex(CornerMesh::next(c.value()));
  }
  [[nodiscard]] static draco::CornerIndex Previous(draco::CornerIndex c) {
    return draco::CornerIndex(CornerMesh::previous(c.value()));
  }
  [[nodiscard]] draco::VertexIndex Vertex(draco::CornerIndex c) const {
    return draco::VertexIndex(mesh_.vertex(c.value()));
  }
  [[nodiscard]] draco::CornerIndex Opposite(draco::CornerIndex c) const {
    return draco::CornerIndex(mesh_.opposite(c.value()));
  }
  [[nodiscard]] draco::CornerIndex SwingLeft(draco::CornerIndex c) const {
    return draco::CornerIndex(mesh_.swing_left(c.value()));
  }
  [[nodiscard]] draco::CornerIndex SwingRight(draco::CornerIndex c) const {
    return draco::CornerIndex(c == draco::kInvalidCornerIndex ? none : mesh_.swing_right(c.value()));
  }

 private:
  const CornerMesh& mesh_;
};
static_assert(draco::kInvalidCornerIndex.value() == none);

using MeshData = draco::MeshPredictionSchemeData<CornerTable>;
template <class Transform>
using Predictor = draco::PredictionSchemeEncoder<int32_t, Transform>;

/// An attribute's values as integers, in the order in which they are written.
struct Integers {
  uint32_t components;
  std::vector<int32_t> values;
};

template <class Number>
void append_integers(const OutputAttribute& attribute, const char* bytes, std::vector<int32_t>& out) {
  for (uint32_t i = 0; i < attribute.components; ++i) {
    Number number;
    std::memcpy(&number, bytes + i * sizeof number, sizeof number);
    out.push_back(static_cast<int32_t>(number));
  }
}

/// Rounds as Draco does, to the bit.
class Rounding {
 public:
  explicit Rounding(const OutputAttribute& attribute) : attribute_(attribute) {
    if (attribute.coding == Coding::octahedral) octahedron_.SetQuantizationBits(attribute.bits);
    if (attribute.coding == Coding::grid) grid_.Init(attribute.grid.range, (1 << attribute.bits) - 1);
  }
  [[nodiscard]] uint32_t components() const {
    return attribute_.coding == Coding::octahedral ? 2 : attribute_.components;
  }
  void append(const char* bytes, std::vector<int32_t>& out) {
    if (attribute_.coding == Coding::integers) {
      with_number(attribute_.format.type, [&](auto zero) { append_integers<decltype(zero)>(attribute_, bytes, out); });
      return;
    }
    floats_.resize(attribute_.components);
    std::memcpy(floats_.data(), bytes, floats_.size() * sizeof(float));
    if (attribute_.coding == Coding::octahedral) {
      int32_t s = 0;
      int32_t t = 0;
      octahedron_.FloatVectorToQuantizedOctahedralCoords(floats_.data(), &s, &t);
      out.insert(out.end(), {s, t});
    } else {
      for (uint32_t i = 0; i < floats_.size(); ++i)
        out.push_back(grid_.QuantizeFloat(floats_[i] - attribute_.grid.origin[i]));
    }
  }

 private:
  const OutputAttribute& attribute_;
  draco::OctahedronToolBox octahedron_;
  draco::Quantizer grid_;
  std::vector<float> floats_;
};

/// Writes the values of one attribute.
class ValueWriter {
 public:
  ValueWriter(const OutputAttribute& attribute, const CornerMesh& mesh, const Array<uint32_t>& corners, int speed)
      : attribute_(attribute), table_(mesh), speed_(speed), place_(mesh.vertex_count(), -1) {
    corners_.reserve(corners.size());
    for (uint32_t c : corners) {
      place_[mesh.vertex(c)] = static_cast<int32_t>(corners_.size());
      corners_.emplace_back(c);
    }
    mesh_data_.Set(nullptr, &table_, &corners_, &place_);
  }

  bool run(const Array<uint32_t>& value, const WrittenSurface& surface, draco::EncoderBuffer& out) {
    const Integers integers = to_integers(value);
    if (needs_positions()) remember_positions(surface);
    if (attribute_.coding == Coding::octahedral) return write(integers, octahedral_predictor(), out);
    return write(integers, predictor(), out);
  }

 private:
  [[nodiscard]] Integers to_integers(const Array<uint32_t>& value) const {
    Rounding rounding(attribute_);
    Integers integers{rounding.components(), {}};
    integers.values.reserve(corners_.size() * integers.components);
    const size_t stride = size_t{attribute_.components} * draco::DataTypeLength(draco_type(attribute_.format.type));
    for (draco::CornerIndex c : corners_)
      rounding.append(attribute_.values.bytes.data() + value[c.value()] * stride, integers.values);
    return integers;
  }

  [[nodiscard]] bool is_texture() const {
    return attribute_.coding == Coding::grid && attribute_.format.kind == AttributeKind::tex_coord &&
           attribute_.components == texture_components;
  }
  [[nodiscard]] bool needs_positions() const {
    return speed_ < geometric_below && (attribute_.coding == Coding::octahedral || is_texture());
  }

  void remember_positions(const WrittenSurface& surface) {
    draco::GeometryAttribute description;
    description.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false, 3 * sizeof(int32_t), 0);
    positions_.emplace(description);
    positions_->Reset(surface.positions.size());
    positions_->SetIdentityMapping();
    for (uint32_t v = 0; v < surface.positions.size(); ++v)
      positions_->SetAttributeValue(draco::AttributeValueIndex(v), &surface.positions[v]);
    vertices_.reserve(corners_.size());
    for (draco::CornerIndex c : corners_) vertices_.emplace_back(surface.mesh.vertex(c.value()));
  }

  [[nodiscard]] std::unique_ptr<Predictor<Wrap>> predictor() const {
    if (needs_positions())
      return std::make_unique<draco::MeshPredictionSchemeTexCoordsPortableEncoder<int32_t, Wrap, MeshData>>(
          nullptr, Wrap(), mesh_data_);
    if (speed_ >= difference_speed || attribute_.format.kind == AttributeKind::normal)
      return std::make_unique<draco::PredictionSchemeDeltaEncoder<int32_t, Wrap>>(nullptr, Wrap());
    return std::make_unique<draco::MeshPredictionSchemeParallelogramEncoder<int32_t, Wrap, MeshData>>(nullptr, Wrap(),
                                                                                                      mesh_data_);
  }
  [[nodiscard]] std::unique_ptr<Predictor<Octahedron>> octahedral_predictor() const {
    const Octahedron octahedron((1 << attribute_.bits) - 1);
    if (needs_positions())
      return std::make_unique<draco::MeshPredictionSchemeGeometricNormalEncoder<int32_t, Octahedron, MeshData>>(
          nullptr, octahedron, mesh_data_);
    return std::make_unique<draco::PredictionSchemeDeltaEncoder<int32_t, Octahedron>>(nullptr, octahedron);
  }

  template <class Transform>
  bool write(const Integers& integers, std::unique_ptr<Predictor<Transform>> predictor, draco::EncoderBuffer& out) {
    const auto count = static_cast<int>(integers.values.size());
    const auto components = static_cast<int>(integers.components);
    std::vector<int32_t> corrections(integers.values.size());
    if (positions_ && !predictor->SetParentAttribute(&*positions_)) return false;
    if (!predictor->ComputeCorrectionValues(integers.values.data(), corrections.data(), count, components,
                                            vertices_.data()))
      return false;
    auto* symbols = reinterpret_cast<uint32_t*>(corrections.data());
    if (!predictor->AreCorrectionsPositive()) draco::ConvertSignedIntsToSymbols(corrections.data(), count, symbols);
    out.Encode(static_cast<int8_t>(predictor->GetPredictionMethod()));
    out.Encode(static_cast<int8_t>(predictor->GetTransformType()));
    out.Encode(uint8_t{1});  // entropy coded
    write_symbols(std::span(symbols, integers.values.size()), integers.components, 10 - speed_, out);
    return predictor->EncodePredictionData(&out);
  }

  const OutputAttribute& attribute_;
  const CornerTable table_;
  int speed_;
  std::vector<draco::CornerIndex> corners_;         ///< at which each value is written
  std::vector<int32_t> place_;                      ///< [vertices] of the surface cut open: among the values
  std::optional<draco::PointAttribute> positions_;  ///< of the vertices, where they predict
  std::vector<draco::PointIndex> vertices_;         ///< of each value's position
  MeshData mesh_data_;
};

}  // namespace

bool can_write(const OutputAttribute& attribute) {
  return attribute.coding != Coding::as_is && !attribute.is_too_large && attribute.format.name.empty();
}

void describe(const OutputAttribute& attribute, draco::EncoderBuffer& out) {
  out.Encode(static_cast<uint8_t>(draco_type(attribute.format.kind)));
  out.Encode(static_cast<uint8_t>(draco_type(attribute.format.type)));
  out.Encode(static_cast<uint8_t>(attribute.components));
  out.Encode(static_cast<uint8_t>(attribute.format.normalized ? 1 : 0));
  draco::EncodeVarint<uint32_t>(attribute.format.id, &out);
}

uint8_t coding_byte(const OutputAttribute& attribute) { return static_cast<uint8_t>(attribute.coding); }

bool write_values(const OutputAttribute& attribute, const Seams& seams, const WrittenSurface& surface, int speed,
                  draco::EncoderBuffer& out) {
  if (seams.empty())
    return ValueWriter(attribute, surface.mesh, surface.order.corners, speed).run(seams.value, surface, out);
  const CornerMesh open = cut_open(surface.mesh, seams);
  return ValueWriter(attribute, open, order_vertices(open, surface.starts).corners, speed)
      .run(seams.value, surface, out);
}

void write_coding(const OutputAttribute& attribute, draco::EncoderBuffer& out) {
  if (attribute.coding == Coding::integers) return;
  if (attribute.coding == Coding::grid) {
    for (const float origin : attribute.grid.origin) out.Encode(origin);
    out.Encode(attribute.grid.range);
  }
  out.Encode(static_cast<uint8_t>(attribute.bits));
}

}  // namespace papilio::proto::edgebreaker
