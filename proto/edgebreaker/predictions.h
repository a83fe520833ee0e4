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
#include "proto/edgebreaker/poller.h"

// libdraco's predictions of values at corners, applied to corner meshes.

namespace papilio::proto::edgebreaker {

/// Adapter from a corner mesh to the corner table that libdraco's predictions expect. `poller` steps at each look-up of
/// a vertex, so that predictions can be cancelled.
class CornerTable {
 public:
  CornerTable(const CornerMesh& mesh, Poller& poller) : mesh_(mesh), poller_(poller) {}
  [[nodiscard]] static draco::CornerIndex Next(draco::CornerIndex c) {
    return draco::CornerIndex(CornerMesh::next(c.value()));
  }
  [[nodiscard]] static draco::CornerIndex Previous(draco::CornerIndex c) {
    return draco::CornerIndex(CornerMesh::previous(c.value()));
  }
  [[nodiscard]] draco::VertexIndex Vertex(draco::CornerIndex c) const {
    poller_.step();
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
  Poller& poller_;
};
static_assert(draco::kInvalidCornerIndex.value() == none);

using MeshData = draco::MeshPredictionSchemeData<CornerTable>;
using Wrap = draco::PredictionSchemeWrapEncodingTransform<int32_t>;
using Octahedron = draco::PredictionSchemeNormalOctahedronCanonicalizedEncodingTransform<int32_t>;
template <class Transform>
using Predictor = draco::PredictionSchemeEncoder<int32_t, Transform>;

/// Surface with the corners [values] of its values, in writing order.
class OrderedSurface {
 public:
  OrderedSurface(const CornerMesh& mesh, const Buffer<uint32_t>& corners, Poller& poller);
  OrderedSurface(const OrderedSurface&) = delete;
  OrderedSurface& operator=(const OrderedSurface&) = delete;
  ~OrderedSurface() = default;

  [[nodiscard]] const std::vector<draco::CornerIndex>& corners() const { return corners_; }
  [[nodiscard]] const MeshData& data() const { return data_; }

 private:
  const CornerTable table_;
  std::vector<draco::CornerIndex> corners_;
  std::vector<int32_t> value_index_;  ///< [vertices] index of the vertex's value; -1: none
  MeshData data_;
};

/// Integer values in writing order.
struct Integers {
  uint32_t components;
  std::vector<int32_t> values;
};

/// Returns the predictor that libdraco selects for values without a parent attribute. `speed`: Draco's, 0 to 10.
/// `points`: points of the mesh.
[[nodiscard]] std::unique_ptr<Predictor<Wrap>> wrapped_predictor(const OrderedSurface& surface, int speed,
                                                                 uint32_t points);

/// Returns a predictor that takes the previous value as the prediction.
[[nodiscard]] std::unique_ptr<Predictor<Wrap>> difference_predictor();

/// Writes the values as differences from their predictions. `vertices` [values]: points of the parent attribute; empty
/// for predictors without one. Returns false and writes nothing if a prediction overflows.
template <class Transform>
[[nodiscard]] bool write_predicted(const Integers& integers, Predictor<Transform>& predictor,
                                   std::span<const draco::PointIndex> vertices, int speed, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
