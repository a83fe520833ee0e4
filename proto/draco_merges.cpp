#include "proto/draco_merges.h"

#include <draco/compression/bit_coders/rans_bit_decoder.h>
#include <draco/compression/config/compression_shared.h>
#include <draco/compression/entropy/symbol_decoding.h>
#include <draco/compression/mesh/mesh_edgebreaker_shared.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "papilio/buffer.h"
#include "papilio/mesh.h"
#include "proto/problem.h"

namespace papilio::proto {
namespace {

/// Connectivity section of a stream, up to its symbols.
struct Connectivity {
  uint8_t traversal = 0;
  uint32_t vertices = 0, faces = 0, symbols = 0, splits = 0;
  uint8_t attributes = 0;
  draco::DecoderBuffer rest;  ///< bytes not yet read
};

std::optional<Connectivity> read_counts(std::string_view bytes) {
  Connectivity c;
  c.rest.Init(bytes.data(), bytes.size(), DRACO_BITSTREAM_VERSION(2, 2));
  if (!c.rest.Decode(&c.traversal) || !draco::DecodeVarint(&c.vertices, &c.rest) ||
      !draco::DecodeVarint(&c.faces, &c.rest) || !c.rest.Decode(&c.attributes) ||
      !draco::DecodeVarint(&c.symbols, &c.rest) || !draco::DecodeVarint(&c.splits, &c.rest))
    return std::nullopt;
  if (c.symbols > c.faces || c.splits > c.symbols) return std::nullopt;
  return c;
}

/// Topology split event: an edge is joined to a split symbol that is decoded later.
struct Event {
  uint32_t source, split;  ///< symbols, numbered from the last
  bool is_right = false;
};

std::optional<std::vector<Event>> read_events(Connectivity& c) {
  uint32_t count = 0;
  if (!draco::DecodeVarint(&count, &c.rest) || count > c.faces) return std::nullopt;
  std::vector<Event> events(count);
  uint32_t last = 0;
  for (Event& event : events) {
    uint32_t ahead = 0;
    uint32_t back = 0;
    if (!draco::DecodeVarint(&ahead, &c.rest) || !draco::DecodeVarint(&back, &c.rest)) return std::nullopt;
    event.source = last += ahead;
    if (back > event.source) return std::nullopt;
    event.split = event.source - back;
  }
  if (events.empty()) return events;
  c.rest.StartBitDecoding(false, nullptr);
  for (Event& event : events) {
    uint32_t bit = 0;
    c.rest.DecodeLeastSignificantBits32(1, &bit);
    event.is_right = bit == draco::RIGHT_FACE_EDGE;
  }
  c.rest.EndBitDecoding();
  return events;
}

/// Decoder of the symbols of the standard traversal.
class StandardSymbols {
 public:
  bool start(Connectivity& c) {
    bits_ = c.rest;
    uint64_t size = 0;
    return bits_.StartBitDecoding(true, &size);
  }
  uint32_t next(uint32_t /*valence*/) {
    uint32_t symbol = 0;
    bits_.DecodeLeastSignificantBits32(1, &symbol);
    if (symbol == draco::TOPOLOGY_C) return symbol;
    uint32_t more = 0;
    bits_.DecodeLeastSignificantBits32(2, &more);
    return symbol | more << 1U;
  }

 private:
  draco::DecoderBuffer bits_;
};

/// Decoder of the symbols of the valence traversal. `valence`: valence of the active vertex.
class ValenceSymbols {
 public:
  bool start(Connectivity& c) {
    draco::RAnsBitDecoder skipped;  // the starts, and each attribute's seams
    for (int i = 0; i < 1 + c.attributes; ++i)
      if (!skipped.StartDecoding(&c.rest)) return false;
    for (std::vector<uint32_t>& list : lists_) {
      uint32_t count = 0;
      if (!draco::DecodeVarint(&count, &c.rest) || count > c.faces) return false;
      list.resize(count);
      if (count > 0 && !draco::DecodeSymbols(count, 1, &c.rest, list.data())) return false;
    }
    return true;
  }
  uint32_t next(uint32_t valence) {
    if (valence == 0) return draco::TOPOLOGY_E;  // the first one
    std::vector<uint32_t>& list = lists_[std::clamp(valence, least_valence, most_valence) - least_valence];
    if (list.empty() || list.back() >= std::size(draco::edge_breaker_symbol_to_topology_id))
      return draco::TOPOLOGY_INVALID;
    const uint32_t symbol = draco::edge_breaker_symbol_to_topology_id[list.back()];
    list.pop_back();
    return symbol;
  }

 private:
  static constexpr uint32_t least_valence = 2, most_valence = 7;
  std::array<std::vector<uint32_t>, most_valence - least_valence + 1> lists_;
};

/// Simulation of the decoder on boundaries only. A boundary vertex has a next and a previous vertex and a number of
/// faces. A boundary edge is identified by its first vertex.
class DecoderSimulation {
 public:
  DecoderSimulation(const Connectivity& c, std::vector<Event> events)
      : symbols_(c.symbols), events_(std::move(events)) {
    vertices_.reserve(size_t{c.vertices} + c.splits);
  }

  /// Decodes symbols up to the first damage or the limit. Returns the number of renumbered corners.
  template <class Symbols>
  uint64_t run(Symbols& symbols) {
    for (at_ = 0; at_ < symbols_ && renumbered_ <= most_renumbered_corners; ++at_) {
      const uint32_t symbol = symbols.next(active_.empty() ? 0 : vertices_[active_.back()].faces + 1);
      if (symbol == draco::TOPOLOGY_E)
        add_triangle();
      else if (active_.empty() || !add(symbol))
        break;
    }
    return renumbered_;
  }

 private:
  struct BoundaryVertex {
    uint32_t next, previous, faces;
  };

  void link(uint32_t from, uint32_t to) {
    vertices_[from].next = to;
    vertices_[to].previous = from;
  }
  uint32_t add_vertex() {
    vertices_.push_back({0, 0, 1});
    return static_cast<uint32_t>(vertices_.size() - 1);
  }

  void add_triangle() {
    const uint32_t a = add_vertex();
    const uint32_t b = add_vertex();
    const uint32_t c = add_vertex();
    link(a, b);
    link(b, c);
    link(c, a);
    active_.push_back(b);
    apply_events(a, c);
  }

  bool add(uint32_t symbol) {
    const uint32_t from = active_.back();
    const uint32_t to = vertices_[from].next;
    switch (symbol) {
      case draco::TOPOLOGY_C:
        close(from, to);
        return true;
      case draco::TOPOLOGY_R:
      case draco::TOPOLOGY_L: {
        const uint32_t added = add_vertex();
        ++vertices_[from].faces;
        ++vertices_[to].faces;
        link(from, added);
        link(added, to);
        if (symbol == draco::TOPOLOGY_L) active_.back() = added;
        if (symbol == draco::TOPOLOGY_R)
          apply_events(to, added);
        else
          apply_events(from, to);
        return true;
      }
      case draco::TOPOLOGY_S:
        return merge(from, to);
      default:
        return false;
    }
  }

  void close(uint32_t vertex, uint32_t to) {
    const uint32_t before = vertices_[vertex].previous;
    ++vertices_[before].faces;
    ++vertices_[to].faces;
    link(before, to);
    active_.back() = before;
  }

  /// Merges the first vertex of the last active edge into the last vertex of the active edge before it.
  bool merge(uint32_t vertex, uint32_t to) {
    active_.pop_back();
    if (const auto joined = joined_.find(at_); joined != joined_.end()) active_.push_back(joined->second);
    if (active_.empty()) return false;
    const uint32_t from = active_.back();
    const uint32_t kept = vertices_[from].next;
    renumbered_ += vertices_[vertex].faces;
    vertices_[kept].faces += vertices_[vertex].faces + 1;
    ++vertices_[from].faces;
    ++vertices_[to].faces;
    link(vertices_[vertex].previous, kept);
    link(from, to);
    return true;
  }

  /// Applies the split events of the added face. `corner`: its corner opposite to the active edge. `before`: the
  /// previous corner.
  void apply_events(uint32_t corner, uint32_t before) {
    const uint32_t source = symbols_ - at_ - 1;
    for (; !events_.empty() && events_.back().source == source; events_.pop_back())
      joined_[symbols_ - events_.back().split - 1] = events_.back().is_right ? before : corner;
  }

  uint32_t symbols_;
  std::vector<Event> events_;
  Buffer<BoundaryVertex> vertices_;                ///< [vertices]
  std::vector<uint32_t> active_;                   ///< stack of active edges
  std::unordered_map<uint32_t, uint32_t> joined_;  ///< [split symbol] edge joined by an event
  uint32_t at_ = 0;
  uint64_t renumbered_ = 0;
};

template <class Symbols>
uint64_t count_renumbered(Connectivity& c, std::vector<Event> events) {
  Symbols symbols;
  return symbols.start(c) ? DecoderSimulation(c, std::move(events)).run(symbols) : 0;
}

uint64_t count_renumbered(Connectivity& c) {
  std::optional<std::vector<Event>> events = read_events(c);
  if (!events) return 0;
  switch (c.traversal) {
    case draco::MESH_EDGEBREAKER_STANDARD_ENCODING:
      return count_renumbered<StandardSymbols>(c, std::move(*events));
    case draco::MESH_EDGEBREAKER_VALENCE_ENCODING:
      return count_renumbered<ValenceSymbols>(c, std::move(*events));
    default:
      return 0;
  }
}

}  // namespace

uint64_t count_renumbered_corners(std::string_view bytes, const DracoHeader& header) {
  std::optional<Connectivity> c = read_counts(bytes.substr(header.connectivity));
  return c ? count_renumbered(*c) : 0;
}

void require_bounded_merges(std::string_view bytes, const DracoHeader& header) {
  std::optional<Connectivity> c = read_counts(bytes.substr(header.connectivity));
  if (!c || uint64_t{c->splits} * c->faces <= most_renumbered_corners) return;
  if (c->traversal == draco::MESH_EDGEBREAKER_PREDICTIVE_ENCODING)
    throw Problem(Code::mesh_unsupported,
                  "The Draco stream has " + std::to_string(c->faces) + " faces and " + std::to_string(c->splits) +
                      " split symbols by the predictive traversal; their product exceeds " +
                      std::to_string(most_renumbered_corners) + ". Encode the mesh with Draco 1.3 or later.");
  if (count_renumbered(*c) > most_renumbered_corners)
    throw Problem(Code::mesh_unsupported,
                  "Decoding the Draco stream would renumber more than " + std::to_string(most_renumbered_corners) +
                      " corners: it merges vertices of many faces too often. Encode the mesh again.");
}

}  // namespace papilio::proto
