#pragma once

#include <draco/compression/mesh/mesh_edgebreaker_shared.h>
#include <draco/core/encoder_buffer.h>
#include <draco/core/varint_encoding.h>

#include <algorithm>
#include <array>
#include <vector>

#include "proto/edgebreaker/corner_mesh.h"
#include "proto/edgebreaker/symbols.h"

// Coders of the symbols of the edgebreaker walk (C, L, E, R, S). For connectivity.cpp only.

namespace papilio::proto::edgebreaker {

/// State of a face during the walk.
enum FaceState : uint8_t { unvisited, visited, visited_split };

/// Coder of the standard traversal: a fixed number of bits for each symbol.
class StandardSymbols {
 public:
  explicit StandardSymbols(CornerMesh& mesh) { symbols_.reserve(mesh.face_count()); }

  void put(draco::EdgebreakerTopologyBitPattern symbol, uint32_t /*corner*/, const Buffer<uint8_t>& /*faces*/) {
    symbols_.push_back(static_cast<uint8_t>(symbol));
  }
  [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(symbols_.size()); }

  /// Writes the symbols last to first: in the order in which they are decoded.
  void write_before_starts(draco::EncoderBuffer& out) const {
    std::vector<char> bytes;
    bytes.reserve(symbols_.size() * 3 / 8 + 8);
    uint64_t bits = 0;
    int bit_count = 0;
    for (size_t i = symbols_.size(); i-- > 0;) {
      bits |= uint64_t{symbols_[i]} << bit_count;
      bit_count += draco::edge_breaker_topology_bit_pattern_length[symbols_[i]];
      for (; bit_count >= 8; bit_count -= 8, bits >>= 8) bytes.push_back(static_cast<char>(bits));
    }
    if (bit_count > 0) bytes.push_back(static_cast<char>(bits));
    draco::EncodeVarint<uint64_t>(bytes.size(), &out);
    out.Encode(bytes.data(), bytes.size());
  }
  void write_after_starts(draco::EncoderBuffer& /*out*/) const {}

 private:
  Buffer<uint8_t> symbols_;
};

/// Coder of the valence traversal. The context of a symbol is a valence: that of the vertex at `next(corner)` when the
/// following symbol is put, among the faces not yet written. A split symbol also splits its vertex: until destruction,
/// corners of the mesh beyond the split are at a new vertex.
class ValenceSymbols {
 public:
  explicit ValenceSymbols(CornerMesh& mesh) : mesh_(mesh), valence_(mesh.vertex_count(), 0) {
    for (uint32_t c = 0; c < mesh.corner_count(); ++c) ++valence_[mesh.vertex(c)];
    // A boundary vertex has one more edge than faces.
    for (uint32_t c : mesh.at_boundary()) ++valence_[mesh.vertex(CornerMesh::next(c))];
  }
  ValenceSymbols(const ValenceSymbols&) = delete;
  ValenceSymbols& operator=(const ValenceSymbols&) = delete;
  ~ValenceSymbols() {
    for (size_t i = moved_.size(); i-- > 0;) mesh_.set_vertex(moved_[i].corner, moved_[i].vertex);
  }

  void put(draco::EdgebreakerTopologyBitPattern symbol, uint32_t corner, const Buffer<uint8_t>& faces) {
    ++count_;
    const uint32_t next = CornerMesh::next(corner);
    const int context_valence = valence_[mesh_.vertex(next)];
    const bool is_end = symbol == draco::TOPOLOGY_E;
    remove_edges(next, is_end || symbol == draco::TOPOLOGY_L ? 2 : 1);
    remove_edges(CornerMesh::previous(corner), is_end || symbol == draco::TOPOLOGY_R ? 2 : 1);
    if (symbol == draco::TOPOLOGY_S)
      split(corner, faces);
    else if (symbol != draco::TOPOLOGY_C)
      remove_edges(corner, is_end ? 2 : 1);
    if (last_ >= 0) {
      const auto context = static_cast<size_t>(std::clamp(context_valence, min_valence, max_valence) - min_valence);
      contexts_[context].push_back(draco::edge_breaker_topology_to_symbol_id[last_]);
    }
    last_ = symbol;
  }
  [[nodiscard]] uint32_t count() const { return count_; }

  void write_before_starts(draco::EncoderBuffer& /*out*/) const {}
  void write_after_starts(draco::EncoderBuffer& out) const { write_symbol_lists(contexts_, out); }

 private:
  static constexpr int min_valence = 2, max_valence = 7;

  void remove_edges(uint32_t corner, int count) { valence_[mesh_.vertex(corner)] -= count; }

  /// Splits the vertex at the corner: the side with fewer unvisited faces gets a new vertex. Both sides are counted in
  /// step until the smaller one ends, so each face changes its vertex O(log F) times.
  void split(uint32_t corner, const Buffer<uint8_t>& faces) {
    const auto is_unvisited = [&](uint32_t c) { return c != none && faces[CornerMesh::face(c)] == unvisited; };
    uint32_t left = mesh_.left(corner);
    uint32_t right = mesh_.right(corner);
    int count = 0;
    for (; is_unvisited(left) && is_unvisited(right); ++count) {
      left = mesh_.right(left);
      right = mesh_.left(right);
    }
    const auto added = static_cast<uint32_t>(valence_.size());
    const auto move = [&](uint32_t c) {
      moved_.push_back({c, mesh_.vertex(c)});
      mesh_.set_vertex(c, added);
    };
    const uint32_t vertex = mesh_.vertex(corner);
    if (!is_unvisited(left))
      for (uint32_t c = mesh_.left(corner); is_unvisited(c); c = mesh_.right(c)) move(CornerMesh::previous(c));
    else
      for (uint32_t c = mesh_.right(corner); is_unvisited(c); c = mesh_.left(c)) move(CornerMesh::next(c));
    // A vertex has one more edge than unvisited faces, before the split and on both sides after it.
    valence_[vertex] -= count + 1;
    valence_.push_back(count + 1);
  }

  struct Moved {
    uint32_t corner, vertex;
  };

  CornerMesh& mesh_;
  Buffer<int> valence_;  ///< [vertices of the mesh, then vertices added by splits]
  Buffer<Moved> moved_;  ///< corners moved to a new vertex, with their vertices before
  int last_ = -1;        ///< symbol put last, whose context is not yet known; -1: none
  uint32_t count_ = 0;
  std::array<Buffer<uint32_t>, max_valence - min_valence + 1> contexts_;
};

}  // namespace papilio::proto::edgebreaker
