#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "base/memory_guard.h"
#include "base/mutex.h"
#include "detail/check_levels.h"
#include "detail/level_decoder.h"
#include "papilio/detail.h"
#include "papilio/error.h"
#include "papilio/triangle_distance.h"

namespace papilio {
namespace {

/// Returns the largest distance from the last positions, one an edge, to their edges.
double largest_move_of(const Topology& t, const Buffer<Vec3f>& positions) {
  double largest = 0;
  for (uint32_t e = 0; e < t.edge_count(); ++e) {
    const uint32_t h = t.half_edge[e];
    largest = std::max(largest,
                       squared_distance_to_segment(to_double(positions[t.vertex_count + e]),
                                                   to_double(positions[t.origin[h]]), to_double(positions[t.tip(h)])));
  }
  return std::sqrt(largest);
}

class StreamedDetail final : public Detail {
 public:
  explicit StreamedDetail(DetailSource source) : base_(mesh_of_base(source.base)), streams_(std::move(source.levels)) {
    check_levels(base_.topology.face_count(), streams_, face_count_limit);
    decoder_.emplace(base_, true);
    fixed_bytes_ = bytes_while_decoding(*decoder_, base_.topology, base_.topology.vertex_count);
    for (const DetailStream& stream : streams_)
      fixed_bytes_ += stream.bytes.size() + stream.texcoords.bytes.size() + stream.pieces.size() * sizeof(DetailPiece);
    bytes_ = fixed_bytes_;
  }

  [[nodiscard]] bool fits(const Mesh& mesh) const override {
    return mesh.positions == base_.positions && mesh.topology.origin == base_.topology.origin;
  }
  [[nodiscard]] const Topology& base() const override { return base_.topology; }
  [[nodiscard]] int level_count() const override { return static_cast<int>(streams_.size()); }
  [[nodiscard]] std::span<const Vec3f> new_vertices(int level, const std::function<bool()>& cancelled) const override {
    const Level& decoded = decoded_to(level, cancelled);
    return {decoded.vertices.data(), decoded.vertices.size()};
  }
  [[nodiscard]] std::span<const Texcoord> new_texcoords(int level,
                                                        const std::function<bool()>& cancelled) const override {
    const Level& decoded = decoded_to(level, cancelled);
    return {decoded.texcoords.data(), decoded.texcoords.size()};
  }
  [[nodiscard]] std::span<const Colour> new_colours(int level, const std::function<bool()>& cancelled) const override {
    const Level& decoded = decoded_to(level, cancelled);
    return {decoded.colours.data(), decoded.colours.size()};
  }
  [[nodiscard]] double largest_move(int level, const std::function<bool()>& cancelled) const override {
    return decoded_to(level, cancelled).largest_move;
  }
  [[nodiscard]] uint64_t bytes() const override { return bytes_; }

 private:
  struct Level {
    Buffer<Vec3f> vertices;
    Buffer<Texcoord> texcoords;  ///< [H of the split mesh] or empty
    Buffer<Colour> colours;      ///< [H of the split mesh] or empty
    double largest_move = 0;
  };

  static uint64_t bytes_while_decoding(const LevelDecoder& decoder, const Topology& t, size_t vertices) {
    const ValueLevels* values = decoder.values();
    return (values != nullptr ? values->bytes() : 0) + t.half_edge_count() * 3 * sizeof(uint32_t) +
           t.edge_count() * (sizeof(uint32_t) + sizeof(EdgeKind)) + vertices * (sizeof(Vec3f) + sizeof(int32_t));
  }

  /// Decodes the levels up to `level` that are not decoded yet.
  const Level& decoded_to(int level, const std::function<bool()>& cancelled) const {
    const Lock lock(access_);
    while (count_ <= static_cast<size_t>(level)) {
      if (cancelled && cancelled()) throw Error(Fault::cancelled, "The caller asked to stop.");
      guard_memory([&] { decode_next(); });
    }
    return levels_[static_cast<size_t>(level)];
  }

  void decode_next() const {
    std::optional<LevelDecoder> decoder = std::exchange(decoder_, std::nullopt);  // discarded if decoding fails
    if (!decoder) {
      decoder.emplace(base_, true);
      for (size_t l = 0; l < count_; ++l) decoder->decode(streams_[l]);
    }
    const Topology& t = decoder->topology();
    decoder->decode(streams_[count_]);
    const Buffer<Vec3f>& positions = decoder->positions();
    Level& made = levels_[count_];
    made.largest_move = largest_move_of(t, positions);
    if (const ValueLevels* values = decoder->values()) {
      made.texcoords = values->on_half_edges<2>();
      made.colours = values->on_half_edges<3>();
    }
    made.vertices.assign(positions.begin() + t.vertex_count, positions.end());
    ++count_;
    const bool is_done = count_ == streams_.size();
    bytes_ = fixed_bytes_ + positions.size() * sizeof(Vec3f) +
             (is_done ? 0 : bytes_while_decoding(*decoder, t, positions.size()));
    for (const Level& level : levels_)
      bytes_ += level.texcoords.size() * sizeof(Texcoord) + level.colours.size() * sizeof(Colour);
    if (!is_done) decoder_ = std::move(decoder);
  }

  Mesh base_;
  std::vector<DetailStream> streams_;
  uint64_t fixed_bytes_ = 0;
  mutable Mutex access_;                         ///< guards the fields that follow, except `bytes_`
  mutable std::optional<LevelDecoder> decoder_;  ///< decoder of the next level; empty after a failure
  mutable std::array<Level, most_detail_levels> levels_;
  mutable size_t count_ = 0;  ///< number of decoded levels
  mutable std::atomic<uint64_t> bytes_ = 0;
};

}  // namespace

std::shared_ptr<const Detail> stream_detail(DetailSource source) {
  return guard_memory([&] { return std::make_shared<const StreamedDetail>(std::move(source)); });
}

}  // namespace papilio
