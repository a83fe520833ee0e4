#include "proto/edgebreaker/positions.h"

#include <draco/core/quantization_utils.h>
#include <algorithm>
#include <cstring>
#include <span>

#include "proto/edgebreaker/predictions.h"
#include "proto/edgebreaker/symbols.h"

namespace papilio::proto::edgebreaker {
namespace {

GridPoint broadcast(int32_t number) { return GridPoint{number, number, number, number}; }
GridPoint lane_min(GridPoint a, GridPoint b) { return a < b ? a : b; }
GridPoint lane_max(GridPoint a, GridPoint b) { return a > b ? a : b; }

using Floats = float __attribute__((vector_size(16)));

/// Quantizer of positions: bit-identical to draco::Quantizer.
class PositionQuantizer {
 public:
  PositionQuantizer(const QuantizationBox& box, int bits)
      : origin_{box.origin.x, box.origin.y, box.origin.z, 0},
        steps_per_unit_(static_cast<float>((1 << bits) - 1) / box.range) {}
  /// Rounds to the nearest grid point, half a step up.
  [[nodiscard]] GridPoint quantize(Floats p) const {
    const Floats steps = (p - origin_) * steps_per_unit_ + 0.5F;
    const GridPoint towards_zero = __builtin_convertvector(steps, GridPoint);
    return towards_zero + (__builtin_convertvector(towards_zero, Floats) > steps);  // a true lane is -1
  }

 private:
  Floats origin_;
  float steps_per_unit_;
};

/// Differences from predictions, wrapped into the range of the values.
class WrappedDifferences {
 public:
  explicit WrappedDifferences(const Buffer<GridPoint>& values) {
    GridPoint low = values[0];
    GridPoint high = values[0];
    for (const GridPoint& p : values) {
      low = lane_min(low, p);
      high = lane_max(high, p);
    }
    low_ = std::min({low[0], low[1], low[2]});
    high_ = std::max({high[0], high[1], high[2]});
    range_ = 1 + high_ - low_;
    max_ = range_ / 2;
    min_ = -max_;
    if (range_ % 2 == 0) --max_;
  }
  [[nodiscard]] int32_t low() const { return low_; }
  [[nodiscard]] int32_t high() const { return high_; }

  /// Stores three symbols for the entropy coder. Overwrites a fourth element.
  void put(GridPoint value, GridPoint predicted, uint32_t* symbols) const {
    GridPoint difference = value - lane_min(lane_max(predicted, broadcast(low_)), broadcast(high_));
    difference += (difference < broadcast(min_)) & broadcast(range_);
    difference -= (difference > broadcast(max_)) & broadcast(range_);
    const GridPoint coded = (difference + difference) ^ (difference >> 31);
    std::memcpy(symbols, &coded, sizeof(coded));
  }

 private:
  int32_t low_, high_, range_, max_, min_;
};

/// Collector of the symbols of the values' differences.
class DifferenceSymbols {
 public:
  DifferenceSymbols(const CornerMesh& mesh, const Buffer<GridPoint>& values)
      : mesh_(mesh), values_(values), differences_(values), symbols_(3 * values.size() + 1) {}

  [[nodiscard]] const WrappedDifferences& differences() const { return differences_; }
  /// Returns the symbols, three a value.
  [[nodiscard]] const Buffer<uint32_t>& symbols() const { return symbols_; }

  void put_difference(uint32_t corner) { put(corner, last_); }
  /// Puts the difference from the parallelogram over the opposite face, whose three values must have been put.
  void put_parallelogram(uint32_t corner) {
    put(corner, value(CornerMesh::next(corner)) + value(CornerMesh::previous(corner)) - value(mesh_.opposite(corner)));
  }

 private:
  [[nodiscard]] GridPoint value(uint32_t corner) const { return values_[mesh_.vertex(corner)]; }
  void put(uint32_t corner, GridPoint predicted) {
    last_ = value(corner);
    differences_.put(last_, predicted, &symbols_[size_t{3} * count_++]);
  }

  const CornerMesh& mesh_;
  const Buffer<GridPoint>& values_;  ///< [vertices]
  WrappedDifferences differences_;
  Buffer<uint32_t> symbols_;
  uint32_t count_ = 0;
  GridPoint last_{};
};

}  // namespace

Buffer<GridPoint> to_grid(const Buffer<Vec3f>& positions, const Surface& surface, const QuantizationBox& box,
                          int bits) {
  const PositionQuantizer quantizer(box, bits);
  auto values = Buffer<GridPoint>::for_overwrite(surface.mesh.vertex_count());
  for (uint32_t v = 0; v < values.size(); ++v) {
    const Vec3f& p = positions[surface.mesh_vertex(v)];
    values[v] = quantizer.quantize(Floats{p.x, p.y, p.z, 0});
  }
  return values;
}

Box decoded_box(const Buffer<GridPoint>& points, const QuantizationBox& box, int bits) {
  GridPoint low = points[0];
  GridPoint high = points[0];
  for (const GridPoint& point : points)
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], point[c]);
      high[c] = std::max(high[c], point[c]);
    }
  draco::Dequantizer dequantizer;
  dequantizer.Init(box.range, (1 << bits) - 1);
  const auto decoded = [&](const GridPoint& point) {
    return Vec3f{dequantizer.DequantizeFloat(point[0]) + box.origin.x,
                 dequantizer.DequantizeFloat(point[1]) + box.origin.y,
                 dequantizer.DequantizeFloat(point[2]) + box.origin.z};
  };
  return {decoded(low), decoded(high)};
}

void write_positions(const CornerMesh& mesh, const VertexOrder& order, const Buffer<GridPoint>& values,
                     Prediction prediction, int compression_level, Poller& poller, draco::EncoderBuffer& out) {
  const auto count = static_cast<uint32_t>(order.corners.size());
  DifferenceSymbols symbols(mesh, values);
  uint32_t done = 0;
  const auto put_differences = [&](uint32_t end) {
    for (; done < end; ++done, poller.step()) symbols.put_difference(order.corners[done]);
  };
  const auto put_parallelograms = [&](uint32_t end) {
    for (; done < end; ++done, poller.step()) symbols.put_parallelogram(order.corners[done]);
  };
  if (prediction == Prediction::parallelogram) {
    for (uint32_t unpredicted : order.unpredicted) {
      put_parallelograms(unpredicted);
      put_differences(unpredicted + 1);
    }
    put_parallelograms(count);
  }
  put_differences(count);

  constexpr int8_t wrapped = 1;
  out.Encode(static_cast<int8_t>(prediction));
  out.Encode(wrapped);
  out.Encode(uint8_t{1});  // entropy coded
  write_symbols(std::span(symbols.symbols().data(), size_t{3} * count), 3, compression_level, out);
  out.Encode(symbols.differences().low());
  out.Encode(symbols.differences().high());
}

void write_positions_multi_parallelogram(const CornerMesh& mesh, const Buffer<uint32_t>& corners,
                                         const Buffer<GridPoint>& values, int speed, uint32_t points, Poller& poller,
                                         draco::EncoderBuffer& out) {
  const OrderedSurface surface(mesh, corners, poller);
  Integers integers{3, {}};
  integers.values.reserve(3 * corners.size());
  for (uint32_t c : corners) {
    const GridPoint& p = values[mesh.vertex(c)];
    integers.values.insert(integers.values.end(), {p[0], p[1], p[2]});
  }
  (void)write_predicted(integers, *wrapped_predictor(surface, speed, points), {}, speed,
                        out);  // grid points never overflow
}

void write_positions_exactly(const Buffer<Vec3f>& positions, const Surface& surface, const Buffer<uint32_t>& corners,
                             Poller& poller, draco::EncoderBuffer& out) {
  for (uint32_t c : corners) {
    poller.step();
    out.Encode(positions[surface.mesh_vertex(surface.mesh.vertex(c))]);
  }
}

void write_grid(const QuantizationBox& box, int bits, draco::EncoderBuffer& out) {
  for (const float c : {box.origin.x, box.origin.y, box.origin.z, box.range}) out.Encode(c);
  out.Encode(static_cast<uint8_t>(bits));
}

}  // namespace papilio::proto::edgebreaker
