#pragma once

#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_data.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_encoder.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_normal_octahedron_canonicalized_encoding_transform.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_wrap_encoding_transform.h>
#include <draco/core/encoder_buffer.h>

#include <memory>
#include <span>
#include <vector>

#include "proto/edgebreaker/corner_mesh.h"
#include "proto/edgebreaker/pace.h"

// libdraco's predictions of values at corners, on our surfaces.

namespace papilio::proto::edgebreaker {

/// A surface as libdraco's predictions use it. `pace` steps at each vertex looked up: so predictions can be stopped.
class CornerTable {
 public:
  CornerTable(const CornerMesh& mesh, Pace& pace) : mesh_(mesh), pace_(pace) {}
  [[nodiscard]] static draco::CornerIndex Next(draco::CornerIndex c) {
    return draco::CornerIndex(CornerMesh::next(c.value()));
  }
  [[nodiscard]] static draco::CornerIndex Previous(draco::CornerIndex c) {
    return draco::CornerIndex(CornerMesh::previous(c.value()));
  }
  [[nodiscard]] draco::VertexIndex Vertex(draco::CornerIndex c) const {
    pace_.step();
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
  Pace& pace_;
};
static_assert(draco::kInvalidCornerIndex.value() == none);

using MeshData = draco::MeshPredictionSchemeData<CornerTable>;
using Wrap = draco::PredictionSchemeWrapEncodingTransform<int32_t>;
using Octahedron = draco::PredictionSchemeNormalOctahedronCanonicalizedEncodingTransform<int32_t>;
template <class Transform>
using Predictor = draco::PredictionSchemeEncoder<int32_t, Transform>;

/// A surface and the corners [values] at which its values are written, in their order.
class OrderedSurface {
 public:
  OrderedSurface(const CornerMesh& mesh, const Array<uint32_t>& corners, Pace& pace);
  OrderedSurface(const OrderedSurface&) = delete;
  OrderedSurface& operator=(const OrderedSurface&) = delete;
  ~OrderedSurface() = default;

  [[nodiscard]] const std::vector<draco::CornerIndex>& corners() const { return corners_; }
  [[nodiscard]] const MeshData& data() const { return data_; }

 private:
  const CornerTable table_;
  std::vector<draco::CornerIndex> corners_;
  std::vector<int32_t> place_;  ///< [vertices] among the values
  MeshData data_;
};

/// Values as integers, in the order in which they are written.
struct Integers {
  uint32_t components;
  std::vector<int32_t> values;
};

/// How values are predicted where nothing but the values themselves is known, at Draco's `speed`, of a mesh with so
/// many points.
[[nodiscard]] std::unique_ptr<Predictor<Wrap>> wrapped_predictor(const OrderedSurface& surface, int speed,
                                                                 uint32_t points);

/// As the value before.
[[nodiscard]] std::unique_ptr<Predictor<Wrap>> difference_predictor();

/// Writes the values as differences from what is predicted. `vertices` [values] or empty: the points that the
/// predictor's parent attribute is asked for. False, and nothing is written, where a prediction overflows.
template <class Transform>
[[nodiscard]] bool write_predicted(const Integers& integers, Predictor<Transform>& predictor,
                                   std::span<const draco::PointIndex> vertices, int speed, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
