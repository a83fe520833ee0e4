#include "proto/edgebreaker/predictions.h"

#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_constrained_multi_parallelogram_encoder.h>
#include <draco/compression/attributes/prediction_schemes/mesh_prediction_scheme_parallelogram_encoder.h>
#include <draco/compression/attributes/prediction_schemes/prediction_scheme_delta_encoder.h>
#include <draco/core/bit_utils.h>

#include "proto/edgebreaker/speeds.h"
#include "proto/edgebreaker/symbols.h"

namespace papilio::proto::edgebreaker {

OrderedSurface::OrderedSurface(const CornerMesh& mesh, const Buffer<uint32_t>& corners, Poller& poller)
    : table_(mesh, poller), value_index_(mesh.vertex_count(), -1) {
  corners_.reserve(corners.size());
  for (uint32_t c : corners) {
    value_index_[mesh.vertex(c)] = static_cast<int32_t>(corners_.size());
    corners_.emplace_back(c);
  }
  data_.Set(nullptr, &table_, &corners_, &value_index_);
}

std::unique_ptr<Predictor<Wrap>> wrapped_predictor(const OrderedSurface& surface, int speed, uint32_t points) {
  if (speed >= min_difference_speed) return difference_predictor();
  if (speed >= min_single_parallelogram_speed || points < min_multi_parallelogram_points)
    return std::make_unique<draco::MeshPredictionSchemeParallelogramEncoder<int32_t, Wrap, MeshData>>(nullptr, Wrap(),
                                                                                                      surface.data());
  return std::make_unique<draco::MeshPredictionSchemeConstrainedMultiParallelogramEncoder<int32_t, Wrap, MeshData>>(
      nullptr, Wrap(), surface.data());
}

std::unique_ptr<Predictor<Wrap>> difference_predictor() {
  return std::make_unique<draco::PredictionSchemeDeltaEncoder<int32_t, Wrap>>(nullptr, Wrap());
}

template <class Transform>
bool write_predicted(const Integers& integers, Predictor<Transform>& predictor,
                     std::span<const draco::PointIndex> vertices, int speed, draco::EncoderBuffer& out) {
  const auto count = static_cast<int>(integers.values.size());
  std::vector<int32_t> corrections(integers.values.size());
  if (!predictor.ComputeCorrectionValues(integers.values.data(), corrections.data(), count,
                                         static_cast<int>(integers.components), vertices.data()))
    return false;
  auto* symbols = reinterpret_cast<uint32_t*>(corrections.data());
  if (!predictor.AreCorrectionsPositive()) draco::ConvertSignedIntsToSymbols(corrections.data(), count, symbols);
  out.Encode(static_cast<int8_t>(predictor.GetPredictionMethod()));
  out.Encode(static_cast<int8_t>(predictor.GetTransformType()));
  out.Encode(uint8_t{1});  // entropy coded
  write_symbols(std::span(symbols, corrections.size()), integers.components, 10 - speed, out);
  return predictor.EncodePredictionData(&out);
}

template bool write_predicted(const Integers&, Predictor<Wrap>&, std::span<const draco::PointIndex>, int,
                              draco::EncoderBuffer&);
template bool write_predicted(const Integers&, Predictor<Octahedron>&, std::span<const draco::PointIndex>, int,
                              draco::EncoderBuffer&);

}  // namespace papilio::proto::edgebreaker
