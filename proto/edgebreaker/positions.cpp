#include "proto/edgebreaker/positions.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "proto/edgebreaker/predictions.h"
#include "proto/edgebreaker/symbols.h"

namespace papilio::proto::edgebreaker {
namespace {

GridPoint all(int32_t number) { return GridPoint{number, number, number, number}; }
GridPoint smaller(GridPoint a, GridPoint b) { return a < b ? a : b; }
GridPoint larger(GridPoint a, GridPoint b) { return a > b ? a : b; }

using Floats = float __attribute__((vector_size(16)));

/// As Draco rounds, to the bit.
class Grid {
 public:
  Grid(const QuantizationBox& box, int bits)
      : origin_{box.origin.x, box.origin.y, box.origin.z, 0},
        steps_per_unit_(static_cast<float>((1 << bits) - 1) / box.range) {}
  /// Rounded down.
  [[nodiscard]] GridPoint at(Floats p) const {
    const Floats steps = (p - origin_) * steps_per_unit_ + 0.5F;
    const GridPoint towards_zero = __builtin_convertvector(steps, GridPoint);
    return towards_zero + (__builtin_convertvector(towards_zero, Floats) > steps);  // true is -1
  }

 private:
  Floats origin_;
  float steps_per_unit_;
};

/// Corrections of predictions, wrapped into the range that the values have.
class Corrections {
 public:
  explicit Corrections(const Array<GridPoint>& values) {
    GridPoint low = values[0];
    GridPoint high = values[0];
    for (const GridPoint& p : values) {
      low = smaller(low, p);
      high = larger(high, p);
    }
    low_ = std::min({low[0], low[1], low[2]});
    high_ = std::max({high[0], high[1], high[2]});
    range_ = 1 + high_ - low_;
    most_ = range_ / 2;
    least_ = -most_;
    if (range_ % 2 == 0) --most_;
  }
  [[nodiscard]] int32_t low() const { return low_; }
  [[nodiscard]] int32_t high() const { return high_; }

  /// Three symbols for the entropy coder; what is behind them may be written over.
  void put(GridPoint value, GridPoint predicted, uint32_t* symbols) const {
    GridPoint correction = value - smaller(larger(predicted, all(low_)), all(high_));
    correction += (correction < all(least_)) & all(range_);
    correction -= (correction > all(most_)) & all(range_);
    const GridPoint coded = (correction + correction) ^ (correction >> 31);
    std::memcpy(symbols, &coded, sizeof(coded));
  }

 private:
  int32_t low_, high_, range_, most_, least_;
};

/// Puts the corrections of one value after another.
class Writer {
 public:
  Writer(const CornerMesh& mesh, const Array<GridPoint>& values)
      : mesh_(mesh), values_(values), corrections_(values), symbols_(3 * values.size() + 1) {}

  [[nodiscard]] const Corrections& corrections() const { return corrections_; }
  /// Of what was put, three a value.
  [[nodiscard]] const Array<uint32_t>& symbols() const { return symbols_; }

  void put_difference(uint32_t corner) { put(corner, last_); }
  /// Opposite there must be a face all of whose values were put.
  void put_parallelogram(uint32_t corner) {
    put(corner, value(CornerMesh::next(corner)) + value(CornerMesh::previous(corner)) - value(mesh_.opposite(corner)));
  }

 private:
  [[nodiscard]] GridPoint value(uint32_t corner) const { return values_[mesh_.vertex(corner)]; }
  void put(uint32_t corner, GridPoint predicted) {
    last_ = value(corner);
    corrections_.put(last_, predicted, &symbols_[size_t{3} * count_++]);
  }

  const CornerMesh& mesh_;
  const Array<GridPoint>& values_;  ///< [vertices]
  Corrections corrections_;
  Array<uint32_t> symbols_;
  uint32_t count_ = 0;
  GridPoint last_{};
};

}  // namespace

Array<GridPoint> to_grid(const Array<Vec3f>& positions, const Surface& surface, const QuantizationBox& box, int bits) {
  const Grid grid(box, bits);
  Array<GridPoint> values(surface.mesh.vertex_count());
  for (uint32_t v = 0; v < values.size(); ++v) {
    const Vec3f& p = positions[surface.mesh_vertex(v)];
    values[v] = grid.at(Floats{p.x, p.y, p.z, 0});
  }
  return values;
}

void write_positions(const CornerMesh& mesh, const VertexOrder& order, const Array<GridPoint>& values,
                     Prediction prediction, int compression_level, Pace& pace, draco::EncoderBuffer& out) {
  const auto count = static_cast<uint32_t>(order.corners.size());
  Writer writer(mesh, values);
  uint32_t done = 0;
  const auto put_differences = [&](uint32_t end) {
    for (; done < end; ++done, pace.step()) writer.put_difference(order.corners[done]);
  };
  const auto put_parallelograms = [&](uint32_t end) {
    for (; done < end; ++done, pace.step()) writer.put_parallelogram(order.corners[done]);
  };
  if (prediction == Prediction::parallelogram) {
    for (uint32_t alone : order.alone) {
      put_parallelograms(alone);
      put_differences(alone + 1);
    }
    put_parallelograms(count);
  }
  put_differences(count);

  constexpr int8_t wrapped = 1;
  out.Encode(static_cast<int8_t>(prediction));
  out.Encode(wrapped);
  out.Encode(uint8_t{1});  // entropy coded
  write_symbols(std::span(writer.symbols().data(), size_t{3} * count), 3, compression_level, out);
  out.Encode(writer.corrections().low());
  out.Encode(writer.corrections().high());
}

void write_positions_multi_parallelogram(const CornerMesh& mesh, const Array<uint32_t>& corners,
                                         const Array<GridPoint>& values, int speed, uint32_t points, Pace& pace,
                                         draco::EncoderBuffer& out) {
  const OrderedSurface surface(mesh, corners, pace);
  Integers integers{3, {}};
  integers.values.reserve(3 * corners.size());
  for (uint32_t c : corners) {
    const GridPoint& p = values[mesh.vertex(c)];
    integers.values.insert(integers.values.end(), {p[0], p[1], p[2]});
  }
  (void)write_predicted(integers, *wrapped_predictor(surface, speed, points), {}, speed, out);  // it is never refused
}

void write_positions_exactly(const Array<Vec3f>& positions, const Surface& surface, const Array<uint32_t>& corners,
                             Pace& pace, draco::EncoderBuffer& out) {
  for (uint32_t c : corners) {
    pace.step();
    out.Encode(positions[surface.mesh_vertex(surface.mesh.vertex(c))]);
  }
}

void write_grid(const QuantizationBox& box, int bits, draco::EncoderBuffer& out) {
  for (const float c : {box.origin.x, box.origin.y, box.origin.z, box.range}) out.Encode(c);
  out.Encode(static_cast<uint8_t>(bits));
}

}  // namespace papilio::proto::edgebreaker
