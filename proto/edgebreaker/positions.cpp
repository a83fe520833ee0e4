#include "proto/edgebreaker/positions.h"

#include <draco/compression/entropy/symbol_encoding.h>
#include <draco/core/options.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace papilio::proto::edgebreaker {
namespace {

/// A point of the grid.
struct GridPoint {
  int32_t x, y, z;
  friend GridPoint operator+(GridPoint a, GridPoint b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend GridPoint operator-(GridPoint a, GridPoint b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};

/// As Draco rounds, to the bit.
class Grid {
 public:
  Grid(const QuantizationBox& box, int bits)
      : origin_(box.origin), steps_per_unit_(static_cast<float>((1 << bits) - 1) / box.range) {}
  [[nodiscard]] GridPoint at(Vec3f p) const {
    return {step(p.x - origin_.x), step(p.y - origin_.y), step(p.z - origin_.z)};
  }

 private:
  [[nodiscard]] int32_t step(float offset) const {
    return static_cast<int32_t>(std::floor(offset * steps_per_unit_ + 0.5F));
  }
  Vec3f origin_;
  float steps_per_unit_;
};

/// Corrections of predictions, wrapped into the range that the values have.
class Corrections {
 public:
  explicit Corrections(const Array<GridPoint>& values) {
    low_ = high_ = values[0].x;
    for (const GridPoint& p : values) {
      low_ = std::min({low_, p.x, p.y, p.z});
      high_ = std::max({high_, p.x, p.y, p.z});
    }
    range_ = 1 + high_ - low_;
    most_ = range_ / 2;
    least_ = -most_;
    if (range_ % 2 == 0) --most_;
  }
  [[nodiscard]] int32_t low() const { return low_; }
  [[nodiscard]] int32_t high() const { return high_; }

  /// Symbols for the entropy coder.
  void put(GridPoint value, GridPoint predicted, uint32_t* symbols) const {
    symbols[0] = symbol(value.x, predicted.x);
    symbols[1] = symbol(value.y, predicted.y);
    symbols[2] = symbol(value.z, predicted.z);
  }

 private:
  [[nodiscard]] uint32_t symbol(int32_t value, int32_t predicted) const {
    int32_t correction = value - std::clamp(predicted, low_, high_);
    if (correction < least_) correction += range_;
    if (correction > most_) correction -= range_;
    return static_cast<uint32_t>(correction) << 1U ^ static_cast<uint32_t>(correction >> 31);
  }
  int32_t low_, high_, range_, most_, least_;
};

/// What is predicted for the place-th value.
GridPoint predict(const CornerMesh& mesh, const VertexOrder& order, const Array<GridPoint>& values, uint32_t place) {
  const uint32_t beyond = mesh.opposite(order.corners[place]);
  if (beyond != none) {
    const uint32_t far = order.place[mesh.vertex(beyond)];
    const uint32_t next = order.place[mesh.vertex(CornerMesh::next(beyond))];
    const uint32_t previous = order.place[mesh.vertex(CornerMesh::previous(beyond))];
    if (far < place && next < place && previous < place) return values[next] + values[previous] - values[far];
  }
  return values[place - 1];
}

}  // namespace

void write_positions(const CornerMesh& mesh, const VertexOrder& order, const Array<Vec3f>& positions,
                     const QuantizationBox& box, int bits, Prediction prediction, int compression_level,
                     draco::EncoderBuffer& out) {
  const auto count = static_cast<uint32_t>(order.corners.size());
  const Grid grid(box, bits);
  Array<GridPoint> values(count);
  for (uint32_t i = 0; i < count; ++i) values[i] = grid.at(positions[mesh.vertex(order.corners[i])]);

  const Corrections corrections(values);
  Array<uint32_t> symbols(size_t{3} * count);
  corrections.put(values[0], {0, 0, 0}, symbols.data());
  if (prediction == Prediction::parallelogram)
    for (uint32_t i = 1; i < count; ++i) corrections.put(values[i], predict(mesh, order, values, i), &symbols[3 * i]);
  else
    for (uint32_t i = 1; i < count; ++i) corrections.put(values[i], values[i - 1], &symbols[3 * i]);

  constexpr int8_t wrapped = 1;
  out.Encode(static_cast<int8_t>(prediction));
  out.Encode(wrapped);
  out.Encode(uint8_t{1});  // entropy coded
  draco::Options options;
  draco::SetSymbolEncodingCompressionLevel(&options, compression_level);
  if (!draco::EncodeSymbols(symbols.data(), static_cast<int>(symbols.size()), 3, &options, &out))
    throw std::runtime_error("Draco's entropy coder refuses the positions");
  out.Encode(corrections.low());
  out.Encode(corrections.high());
  for (const float c : {box.origin.x, box.origin.y, box.origin.z, box.range}) out.Encode(c);
  out.Encode(static_cast<uint8_t>(bits));
}

}  // namespace papilio::proto::edgebreaker
