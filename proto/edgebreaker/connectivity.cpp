#include "proto/edgebreaker/connectivity.h"

#include <draco/compression/bit_coders/rans_bit_encoder.h>
#include <draco/compression/mesh/mesh_edgebreaker_shared.h>
#include <draco/core/varint_encoding.h>

#include <algorithm>
#include <unordered_map>

#include "proto/edgebreaker/topology_symbols.h"

namespace papilio::proto::edgebreaker {
namespace {

/// Boundary loops: the loop of each vertex, and whether the walk has reached each loop.
class BoundaryLoops {
 public:
  explicit BoundaryLoops(const CornerMesh& mesh) : mesh_(mesh) {
    for (uint32_t c : mesh.at_boundary()) add_loop(c);
  }

  [[nodiscard]] bool has(uint32_t vertex) const { return vertex < loop_.size() && loop_[vertex] != none; }
  [[nodiscard]] bool is_visited(uint32_t vertex) const { return visited_[loop_[vertex]] != 0; }

  /// Marks the loop of the corner's vertex as visited and calls visit(vertex) for its other vertices.
  template <class Visit>
  void visit_loop(uint32_t corner, const Visit& visit) {
    const uint32_t start = mesh_.vertex(corner);
    visited_[loop_[start]] = 1;
    uint32_t c = rotate_to_boundary(CornerMesh::previous(corner));
    for (uint32_t v = mesh_.vertex(CornerMesh::previous(c)); v != start; v = mesh_.vertex(CornerMesh::previous(c))) {
      visit(v);
      c = rotate_to_boundary(CornerMesh::next(c));
    }
  }

 private:
  /// Adds the loop of the boundary edge opposite to the corner, unless it is known.
  void add_loop(uint32_t corner) {
    if (loop_.empty()) loop_.assign(mesh_.vertex_count(), none);
    uint32_t v = mesh_.vertex(CornerMesh::next(corner));
    if (loop_[v] != none) return;
    for (uint32_t c = corner; loop_[v] == none; v = mesh_.vertex(CornerMesh::next(c))) {
      loop_[v] = static_cast<uint32_t>(visited_.size());
      c = rotate_to_boundary(CornerMesh::next(c));
    }
    visited_.push_back(0);
  }

  /// Rotates about a vertex, and returns the corner opposite to its boundary edge.
  [[nodiscard]] uint32_t rotate_to_boundary(uint32_t corner) const {
    while (mesh_.opposite(corner) != none) corner = CornerMesh::next(mesh_.opposite(corner));
    return corner;
  }

  const CornerMesh& mesh_;
  Buffer<uint32_t> loop_;         ///< [vertices] the loop, or `none`; empty for a closed mesh
  std::vector<uint8_t> visited_;  ///< [loops]
};

/// Walk over all faces of a mesh.
template <class Symbols>
class Walk {
 public:
  Walk(CornerMesh& mesh, std::span<const Seams> attributes, Poller& poller)
      : mesh_(mesh),
        attributes_(attributes),
        poller_(poller),
        symbols_(mesh),
        loops_(mesh),
        face_state_(mesh.face_count(), unvisited),
        vertex_visited_(mesh.vertex_count(), 0) {
    corners_.reserve(mesh.face_count());
  }

  Buffer<uint32_t> run(draco::EncoderBuffer& out) {
    start_bits_.StartEncoding();
    for (uint32_t f = 0; f < mesh_.face_count(); ++f)
      if (face_state_[f] == unvisited) walk_component(f);
    std::reverse(corners_.begin(), corners_.end());
    corners_.insert(corners_.end(), inner_starts_.begin(), inner_starts_.end());
    write(out);
    return std::move(corners_);
  }

 private:
  void walk_component(uint32_t face) {
    const uint32_t boundary_corner = find_boundary_corner(face);
    const bool is_inside = boundary_corner == none;
    start_bits_.EncodeBit(is_inside);
    if (is_inside) {
      const uint32_t corner = CornerMesh::first_corner(face);
      for (uint32_t c : {corner, CornerMesh::next(corner), CornerMesh::previous(corner)})
        vertex_visited_[mesh_.vertex(c)] = 1;
      face_state_[face] = visited;
      inner_starts_.push_back(CornerMesh::next(corner));
      const uint32_t opposite = mesh_.right(corner);
      if (face_state_[CornerMesh::face(opposite)] == unvisited) walk_from(opposite);
    } else {
      const uint32_t on_boundary = CornerMesh::next(boundary_corner);
      vertex_visited_[mesh_.vertex(on_boundary)] = 1;
      visit_loop(on_boundary);
      walk_from(boundary_corner);
    }
  }

  /// Returns a corner opposite to a boundary edge at one of the face's vertices; `none` for a face without boundary
  /// vertices.
  [[nodiscard]] uint32_t find_boundary_corner(uint32_t face) const {
    const uint32_t first = CornerMesh::first_corner(face);
    for (uint32_t c = first; c < first + 3; ++c) {
      if (mesh_.opposite(c) == none) return c;
      if (!loops_.has(mesh_.vertex(c))) continue;
      uint32_t last = c;
      for (uint32_t n = c; n != none; n = mesh_.swing_right(n)) last = n;
      return CornerMesh::previous(last);
    }
    return none;
  }

  void visit_loop(uint32_t corner) {
    loops_.visit_loop(corner, [this](uint32_t vertex) { vertex_visited_[vertex] = 1; });
  }

  void walk_from(uint32_t corner) {
    stack_.assign(1, corner);
    while (!stack_.empty()) {
      corner = stack_.back();
      if (is_visited(corner)) {
        stack_.pop_back();
        continue;
      }
      while (corner != none) corner = visit(corner);
    }
  }

  /// Visits the face of the corner. Returns the next corner; `none` where the walk ends or splits.
  uint32_t visit(uint32_t corner) {
    const uint32_t face = CornerMesh::face(corner);
    poller_.step();
    mesh_.prefetch(mesh_.right(corner));
    mesh_.prefetch(mesh_.left(corner));
    const uint32_t vertex = mesh_.vertex(corner);
    face_state_[face] = visited;
    corners_.push_back(corner);
    const bool is_on_boundary = loops_.has(vertex);
    if (is_new(vertex)) {
      vertex_visited_[vertex] = 1;
      if (!is_on_boundary) {
        put(draco::TOPOLOGY_C, corner);
        return mesh_.right(corner);
      }
    }
    const uint32_t right = mesh_.right(corner);
    const uint32_t left = mesh_.left(corner);
    const bool right_visited = is_visited(right);
    const bool left_visited = is_visited(left);
    if (right_visited) record_split_event(right, draco::RIGHT_FACE_EDGE);
    if (left_visited) record_split_event(left, draco::LEFT_FACE_EDGE);
    if (right_visited && left_visited) {
      put(draco::TOPOLOGY_E, corner);
      stack_.pop_back();
      return none;
    }
    if (right_visited) {
      put(draco::TOPOLOGY_R, corner);
      return left;
    }
    if (left_visited) {
      put(draco::TOPOLOGY_L, corner);
      return right;
    }
    if (is_on_boundary && !loops_.is_visited(vertex)) visit_loop(corner);  // before `put` splits the vertex
    put(draco::TOPOLOGY_S, corner);
    ++splits_;
    face_state_[face] = visited_split;
    split_symbol_[face] = symbols_.count() - 1;
    stack_.back() = left;
    stack_.push_back(right);
    return none;
  }

  /// Returns whether the vertex is not yet visited. Vertices added by splits (ValenceSymbols) count as visited.
  [[nodiscard]] bool is_new(uint32_t vertex) const {
    return vertex < vertex_visited_.size() && vertex_visited_[vertex] == 0;
  }

  void put(draco::EdgebreakerTopologyBitPattern symbol, uint32_t corner) { symbols_.put(symbol, corner, face_state_); }

  /// Returns whether the face of the corner is visited; `none` counts as visited.
  [[nodiscard]] bool is_visited(uint32_t corner) const {
    return corner == none || face_state_[CornerMesh::face(corner)] != unvisited;
  }

  /// Records an event where the neighbour of the current face is a split face. The symbol of the current face is not
  /// yet put.
  void record_split_event(uint32_t neighbour, draco::EdgeFaceName edge) {
    if (neighbour == none || face_state_[CornerMesh::face(neighbour)] != visited_split) return;
    draco::TopologySplitEventData event{};
    event.split_symbol_id = split_symbol_.at(CornerMesh::face(neighbour));
    event.source_symbol_id = symbols_.count();
    event.source_edge = edge;
    events_.push_back(event);
  }

  void write(draco::EncoderBuffer& out) {
    draco::EncodeVarint<uint32_t>(mesh_.vertex_count(), &out);
    draco::EncodeVarint<uint32_t>(mesh_.face_count(), &out);
    out.Encode(static_cast<uint8_t>(attributes_.size()));
    draco::EncodeVarint<uint32_t>(symbols_.count(), &out);
    draco::EncodeVarint<uint32_t>(splits_, &out);
    write_events(out);
    symbols_.write_before_starts(out);
    start_bits_.EndEncoding(&out);
    write_seams(out);
    symbols_.write_after_starts(out);
  }

  /// Writes a bit for each inner edge and attribute: whether it is a seam. Edges come in the order of the first of
  /// their faces that a decoder meets.
  void write_seams(draco::EncoderBuffer& out) {
    if (attributes_.empty()) return;
    std::vector<draco::RAnsBitEncoder> bits(attributes_.size());
    for (draco::RAnsBitEncoder& encoder : bits) encoder.StartEncoding();
    std::ranges::fill(face_state_, unvisited);
    for (uint32_t corner : corners_) {
      face_state_[CornerMesh::face(corner)] = visited;
      for (uint32_t c : {corner, CornerMesh::next(corner), CornerMesh::previous(corner)}) {
        if (is_visited(mesh_.opposite(c))) continue;
        for (size_t a = 0; a < bits.size(); ++a)
          bits[a].EncodeBit(!attributes_[a].empty() && attributes_[a].is_seam[c] != 0);
      }
    }
    for (draco::RAnsBitEncoder& encoder : bits) encoder.EndEncoding(&out);
  }

  void write_events(draco::EncoderBuffer& out) const {
    draco::EncodeVarint<uint32_t>(static_cast<uint32_t>(events_.size()), &out);
    if (events_.empty()) return;
    uint32_t last = 0;
    for (const draco::TopologySplitEventData& event : events_) {
      draco::EncodeVarint<uint32_t>(event.source_symbol_id - last, &out);
      draco::EncodeVarint<uint32_t>(event.source_symbol_id - event.split_symbol_id, &out);
      last = event.source_symbol_id;
    }
    out.StartBitEncoding(static_cast<int64_t>(events_.size()), false);
    for (const draco::TopologySplitEventData& event : events_) out.EncodeLeastSignificantBits32(1, event.source_edge);
    out.EndBitEncoding();
  }

  const CornerMesh& mesh_;
  std::span<const Seams> attributes_;
  Poller& poller_;
  Symbols symbols_;
  BoundaryLoops loops_;
  Buffer<uint8_t> face_state_;          ///< [faces] FaceState
  Buffer<uint8_t> vertex_visited_;      ///< [vertices]
  Buffer<uint32_t> corners_;            ///< corner at which each visited face was entered
  std::vector<uint32_t> inner_starts_;  ///< corner of each face without boundary vertices at which a component starts
  std::vector<uint32_t> stack_;
  std::unordered_map<uint32_t, uint32_t> split_symbol_;  ///< symbol number by split face
  std::vector<draco::TopologySplitEventData> events_;
  uint32_t splits_ = 0;
  draco::RAnsBitEncoder start_bits_;
};

}  // namespace

Buffer<uint32_t> write_connectivity(CornerMesh& mesh, Traversal traversal, std::span<const Seams> attributes,
                                    Poller& poller, draco::EncoderBuffer& out) {
  if (traversal == Traversal::standard) return Walk<StandardSymbols>(mesh, attributes, poller).run(out);
  return Walk<ValenceSymbols>(mesh, attributes, poller).run(out);
}

}  // namespace papilio::proto::edgebreaker
