#include "proto/edgebreaker/connectivity.h"

#include <draco/compression/bit_coders/rans_bit_encoder.h>
#include <draco/compression/mesh/mesh_edgebreaker_shared.h>
#include <draco/core/varint_encoding.h>

#include <algorithm>
#include <array>
#include <unordered_map>

#include "proto/edgebreaker/symbols.h"

namespace papilio::proto::edgebreaker {
namespace {

/// What is known of a face during the walk.
enum FaceState : uint8_t { unvisited, visited, visited_split };

/// Collects the symbols, and writes them last to first, as they are decoded.
class StandardSymbols {
 public:
  explicit StandardSymbols(CornerMesh& mesh) { symbols_.reserve(mesh.face_count()); }

  void put(draco::EdgebreakerTopologyBitPattern symbol, uint32_t /*corner*/, const Buffer<uint8_t>& /*faces*/) {
    symbols_.push_back(static_cast<uint8_t>(symbol));
  }
  [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(symbols_.size()); }

  void write_before_starts(draco::EncoderBuffer& out) const {
    std::vector<char> bytes;
    bytes.reserve(symbols_.size() * 3 / 8 + 8);
    uint64_t bits = 0;
    int held = 0;
    for (size_t i = symbols_.size(); i-- > 0;) {
      bits |= uint64_t{symbols_[i]} << held;
      held += draco::edge_breaker_topology_bit_pattern_length[symbols_[i]];
      for (; held >= 8; held -= 8, bits >>= 8) bytes.push_back(static_cast<char>(bits));
    }
    if (held > 0) bytes.push_back(static_cast<char>(bits));
    draco::EncodeVarint<uint64_t>(bytes.size(), &out);
    out.Encode(bytes.data(), bytes.size());
  }
  void write_after_starts(draco::EncoderBuffer& /*out*/) const {}

 private:
  Buffer<uint8_t> symbols_;
};

/// Codes each symbol in the context of the valence, in the part of the mesh that is not yet written, of the vertex that
/// the next one turns round. Where the walk falls in two a vertex does, too: while this lasts, corners of the mesh
/// beyond it are at a new one.
class ValenceSymbols {
 public:
  explicit ValenceSymbols(CornerMesh& mesh) : mesh_(mesh), valence_(mesh.vertex_count(), 0) {
    for (uint32_t c = 0; c < mesh.corner_count(); ++c) ++valence_[mesh.vertex(c)];
    // At a boundary there is one more edge than faces.
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
    const uint32_t previous = CornerMesh::previous(corner);
    const int active = valence_[mesh_.vertex(next)];
    switch (symbol) {
      case draco::TOPOLOGY_C:
        take(next, 1);
        take(previous, 1);
        break;
      case draco::TOPOLOGY_S:
        take(next, 1);
        take(previous, 1);
        split(corner, faces);
        break;
      case draco::TOPOLOGY_R:
        take(corner, 1);
        take(next, 1);
        take(previous, 2);
        break;
      case draco::TOPOLOGY_L:
        take(corner, 1);
        take(next, 2);
        take(previous, 1);
        break;
      default:
        take(corner, 2);
        take(next, 2);
        take(previous, 2);
    }
    if (last_ >= 0) {
      const auto context = static_cast<size_t>(std::clamp(active, least_valence, most_valence) - least_valence);
      contexts_[context].push_back(draco::edge_breaker_topology_to_symbol_id[last_]);
    }
    last_ = symbol;
  }
  [[nodiscard]] uint32_t count() const { return count_; }

  void write_before_starts(draco::EncoderBuffer& /*out*/) const {}
  void write_after_starts(draco::EncoderBuffer& out) const { write_symbol_lists(contexts_, out); }

 private:
  static constexpr int least_valence = 2, most_valence = 7;

  void take(uint32_t corner, int edges) { valence_[mesh_.vertex(corner)] -= edges; }

  /// The vertex at the corner falls in two: the side with fewer faces gets a new one. Both sides are counted at once,
  /// and only until the smaller one ends: a face changes its vertex O(log F) times.
  void split(uint32_t corner, const Buffer<uint8_t>& faces) {
    const auto is_left = [&](uint32_t c) { return c != none && faces[CornerMesh::face(c)] == unvisited; };
    const auto on_left = [&](uint32_t c) { return mesh_.opposite(CornerMesh::next(c)); };
    const auto on_right = [&](uint32_t c) { return mesh_.opposite(CornerMesh::previous(c)); };
    uint32_t left = mesh_.left(corner);
    uint32_t right = mesh_.right(corner);
    int count = 0;
    for (; is_left(left) && is_left(right); ++count) {
      left = on_left(left);
      right = on_right(right);
    }
    const auto added = static_cast<uint32_t>(valence_.size());
    const auto move = [&](uint32_t c) {
      moved_.push_back({c, mesh_.vertex(c)});
      mesh_.set_vertex(c, added);
    };
    const uint32_t vertex = mesh_.vertex(corner);
    if (!is_left(left))
      for (uint32_t c = mesh_.left(corner); is_left(c); c = on_left(c)) move(CornerMesh::previous(c));
    else
      for (uint32_t c = mesh_.right(corner); is_left(c); c = on_right(c)) move(CornerMesh::next(c));
    // The faces still to come at a vertex are one less than its edges, before the split and on either side after it.
    valence_[vertex] -= count + 1;
    valence_.push_back(count + 1);
  }

  struct Moved {
    uint32_t corner, vertex;
  };

  CornerMesh& mesh_;
  Buffer<int> valence_;  ///< [vertices, and those that came of splits]
  Buffer<Moved> moved_;  ///< corners that are at another vertex now, and where they were
  int last_ = -1;
  uint32_t count_ = 0;
  std::array<Buffer<uint32_t>, most_valence - least_valence + 1> contexts_;
};

/// The boundary loops: which vertices are on each, and which loops the walk has come to.
class Holes {
 public:
  explicit Holes(const CornerMesh& mesh) : mesh_(mesh) {
    for (uint32_t c : mesh.at_boundary()) find(c);
  }

  [[nodiscard]] bool has(uint32_t vertex) const { return vertex < hole_.size() && hole_[vertex] != none; }
  [[nodiscard]] bool is_visited(uint32_t vertex) const { return visited_[hole_[vertex]] != 0; }

  /// Calls visit(vertex) for the others on the loop of the corner's vertex.
  template <class Visit>
  void go_round(uint32_t corner, const Visit& visit) {
    const uint32_t start = mesh_.vertex(corner);
    visited_[hole_[start]] = 1;
    uint32_t c = turn(CornerMesh::previous(corner));
    for (uint32_t v = mesh_.vertex(CornerMesh::previous(c)); v != start; v = mesh_.vertex(CornerMesh::previous(c))) {
      visit(v);
      c = turn(CornerMesh::next(c));
    }
  }

 private:
  /// Notes the loop of the corner's opposite edge.
  void find(uint32_t corner) {
    if (hole_.empty()) hole_.assign(mesh_.vertex_count(), none);
    uint32_t v = mesh_.vertex(CornerMesh::next(corner));
    if (hole_[v] != none) return;
    for (uint32_t c = corner; hole_[v] == none; v = mesh_.vertex(CornerMesh::next(c))) {
      hole_[v] = static_cast<uint32_t>(visited_.size());
      c = turn(CornerMesh::next(c));
    }
    visited_.push_back(0);
  }

  /// Round a vertex to the corner opposite to its boundary edge.
  [[nodiscard]] uint32_t turn(uint32_t corner) const {
    while (mesh_.opposite(corner) != none) corner = CornerMesh::next(mesh_.opposite(corner));
    return corner;
  }

  const CornerMesh& mesh_;
  Buffer<uint32_t> hole_;         ///< [vertices] the loop; `none`. Empty where there is none
  std::vector<uint8_t> visited_;  ///< [loops]
};

template <class Symbols>
class Walk {
 public:
  Walk(CornerMesh& mesh, std::span<const Seams> attributes, Pace& pace)
      : mesh_(mesh),
        attributes_(attributes),
        pace_(pace),
        symbols_(mesh),
        holes_(mesh),
        face_state_(mesh.face_count(), unvisited),
        vertex_visited_(mesh.vertex_count(), 0) {
    corners_.reserve(mesh.face_count());
  }

  Buffer<uint32_t> run(draco::EncoderBuffer& out) {
    starts_.StartEncoding();
    for (uint32_t f = 0; f < mesh_.face_count(); ++f)
      if (face_state_[f] == unvisited) start(f);
    std::reverse(corners_.begin(), corners_.end());
    corners_.insert(corners_.end(), first_corners_.begin(), first_corners_.end());
    write(out);
    return std::move(corners_);
  }

 private:
  void start(uint32_t face) {
    uint32_t corner = 0;
    const bool is_inside = find_start(face, corner);
    starts_.EncodeBit(is_inside);
    if (is_inside) {
      for (uint32_t c : {corner, CornerMesh::next(corner), CornerMesh::previous(corner)})
        vertex_visited_[mesh_.vertex(c)] = 1;
      face_state_[face] = visited;
      first_corners_.push_back(CornerMesh::next(corner));
      const uint32_t opposite = mesh_.right(corner);
      if (face_state_[CornerMesh::face(opposite)] == unvisited) walk_from(opposite);
    } else {
      const uint32_t on_hole = CornerMesh::next(corner);
      vertex_visited_[mesh_.vertex(on_hole)] = 1;
      go_round_hole(on_hole);
      walk_from(corner);
    }
  }

  /// Whether the face has no vertex on a boundary. Then its first corner, else one opposite to a boundary edge.
  [[nodiscard]] bool find_start(uint32_t face, uint32_t& corner) const {
    const uint32_t first = CornerMesh::first_corner(face);
    for (uint32_t c = first; c < first + 3; ++c) {
      if (mesh_.opposite(c) == none) {
        corner = c;
        return false;
      }
      if (!holes_.has(mesh_.vertex(c))) continue;
      uint32_t at = c;
      for (uint32_t o = mesh_.opposite(CornerMesh::previous(at)); o != none;
           o = mesh_.opposite(CornerMesh::previous(at)))
        at = CornerMesh::previous(o);
      corner = CornerMesh::previous(at);
      return false;
    }
    corner = first;
    return true;
  }

  void go_round_hole(uint32_t corner) {
    holes_.go_round(corner, [this](uint32_t vertex) { vertex_visited_[vertex] = 1; });
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

  /// The corner to go on with; `none` where the walk ends or falls in two.
  uint32_t visit(uint32_t corner) {
    const uint32_t face = CornerMesh::face(corner);
    pace_.step();
    mesh_.prefetch(mesh_.right(corner));
    mesh_.prefetch(mesh_.left(corner));
    const uint32_t vertex = mesh_.vertex(corner);
    face_state_[face] = visited;
    corners_.push_back(corner);
    const bool on_hole = holes_.has(vertex);
    if (is_new(vertex)) {
      vertex_visited_[vertex] = 1;
      if (!on_hole) {
        put(draco::TOPOLOGY_C, corner);
        return mesh_.right(corner);
      }
    }
    const uint32_t right = mesh_.right(corner);
    const uint32_t left = mesh_.left(corner);
    const bool right_visited = is_visited(right);
    const bool left_visited = is_visited(left);
    if (right_visited) note_split(right, draco::RIGHT_FACE_EDGE);
    if (left_visited) note_split(left, draco::LEFT_FACE_EDGE);
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
    if (on_hole && !holes_.is_visited(vertex)) go_round_hole(corner);  // before the vertex falls in two
    put(draco::TOPOLOGY_S, corner);
    ++splits_;
    face_state_[face] = visited_split;
    split_symbol_[face] = symbols_.count() - 1;
    stack_.back() = left;
    stack_.push_back(right);
    return none;
  }

  /// Vertices that came of splits (ValenceSymbols) are not.
  [[nodiscard]] bool is_new(uint32_t vertex) const {
    return vertex < vertex_visited_.size() && vertex_visited_[vertex] == 0;
  }

  void put(draco::EdgebreakerTopologyBitPattern symbol, uint32_t corner) { symbols_.put(symbol, corner, face_state_); }

  /// Outside counts as visited.
  [[nodiscard]] bool is_visited(uint32_t corner) const {
    return corner == none || face_state_[CornerMesh::face(corner)] != unvisited;
  }

  /// Where the face beside the one at hand is one at which the walk fell in two. The symbol at hand is not yet put.
  void note_split(uint32_t neighbour, draco::EdgeFaceName edge) {
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
    starts_.EndEncoding(&out);
    write_seams(out);
    symbols_.write_after_starts(out);
  }

  /// A bit for each edge of two faces, at the first of them that a decoder meets.
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
  Pace& pace_;
  Symbols symbols_;
  Holes holes_;
  Buffer<uint8_t> face_state_;           ///< [faces] FaceState
  Buffer<uint8_t> vertex_visited_;       ///< [vertices]
  Buffer<uint32_t> corners_;             ///< of the faces visited, in their order
  std::vector<uint32_t> first_corners_;  ///< of the faces at which a walk started
  std::vector<uint32_t> stack_;
  std::unordered_map<uint32_t, uint32_t> split_symbol_;  ///< of a face at which the walk fell in two
  std::vector<draco::TopologySplitEventData> events_;
  uint32_t splits_ = 0;
  draco::RAnsBitEncoder starts_;
};

}  // namespace

Buffer<uint32_t> write_connectivity(CornerMesh& mesh, Traversal traversal, std::span<const Seams> attributes,
                                    Pace& pace, draco::EncoderBuffer& out) {
  if (traversal == Traversal::standard) return Walk<StandardSymbols>(mesh, attributes, pace).run(out);
  return Walk<ValenceSymbols>(mesh, attributes, pace).run(out);
}

}  // namespace papilio::proto::edgebreaker
