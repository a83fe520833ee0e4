#include "detail/pieces.h"

#include <algorithm>
#include <numeric>

namespace papilio {
namespace {

constexpr uint32_t bits_of_axis = 10;

/// Returns the bits of the number with two zeros between neighbours.
uint32_t spread(uint32_t number) {
  uint32_t made = 0;
  for (uint32_t i = 0; i < bits_of_axis; ++i) made |= (number >> i & 1U) << (3 * i);
  return made;
}

/// Returns the place of a point in its box along an axis, 0..1023.
uint32_t place_along(float least, float most, float at) {
  const float share = most > least ? (at - least) / (most - least) : 0;
  return static_cast<uint32_t>(std::clamp(share * 1024, 0.0F, 1023.0F));
}

EdgePieces sorted_by_piece(Buffer<uint16_t> of_edge, uint32_t count) {
  EdgePieces made;
  made.begin.assign(size_t{count} + 1, 0);
  for (const uint16_t piece : of_edge) ++made.begin[size_t{piece} + 1];
  std::partial_sum(made.begin.begin(), made.begin.end(), made.begin.begin());
  Buffer<uint32_t> next(made.begin.begin(), made.begin.end());
  made.edges.resize_for_overwrite(of_edge.size());
  for (uint32_t e = 0; e < of_edge.size(); ++e) made.edges[next[of_edge[e]]++] = e;
  made.of_edge = std::move(of_edge);
  return made;
}

}  // namespace

EdgePieces EdgePieces::on_cut(const Topology& whole, const Topology& cut) const {
  Buffer<uint16_t> of;
  of.reserve(cut.edge_count());
  for (uint32_t e = 0; e < cut.edge_count(); ++e) of.push_back(of_edge[whole.edge[cut.half_edge[e]]]);
  return sorted_by_piece(std::move(of), count());
}

PieceOrder::PieceOrder(const Mesh& base) : corners_(base.topology.origin) {
  const Box box = bounding_box(base.positions);
  struct Place {
    uint32_t along_curve, face;
  };
  std::vector<Place> places;
  for (uint32_t f = 0; f < base.topology.face_count(); ++f) {
    const uint32_t* corner = &base.topology.origin[size_t{3} * f];
    const Vec3f sum = base.positions[corner[0]] + base.positions[corner[1]] + base.positions[corner[2]];
    const Vec3f centre = (1.0F / 3) * sum;
    places.push_back({spread(place_along(box.min.x, box.max.x, centre.x)) |
                          spread(place_along(box.min.y, box.max.y, centre.y)) << 1 |
                          spread(place_along(box.min.z, box.max.z, centre.z)) << 2,
                      f});
  }
  std::ranges::sort(places, [](const Place& a, const Place& b) {
    return a.along_curve != b.along_curve ? a.along_curve < b.along_curve : a.face < b.face;
  });
  rank_.resize(places.size());
  for (uint32_t i = 0; i < places.size(); ++i) rank_[places[i].face] = i;
}

EdgePieces PieceOrder::edges(const Topology& level, uint32_t number, uint32_t count) const {
  Buffer<uint16_t> of;
  of.reserve(level.edge_count());
  for (const uint32_t h : level.half_edge)
    of.push_back(static_cast<uint16_t>(piece_of(Topology::face(h) >> (2 * number), count)));
  return sorted_by_piece(std::move(of), count);
}

std::vector<uint8_t> PieceNeeds::next(const PieceOrder& order, std::span<const DetailPiece> pieces) {
  std::vector<uint8_t> decoded;
  for (const DetailPiece& piece : pieces) decoded.push_back(piece.is_missing ? 0 : 1);
  const auto for_each_corner = [&](const auto& visit) {
    for (uint32_t h = 0; h < order.corners().size(); ++h)
      visit(order.piece_of(Topology::face(h), static_cast<uint32_t>(pieces.size())), order.corners()[h]);
  };
  for_each_corner([&](uint32_t piece, uint32_t vertex) {
    if (is_known_[vertex] == 0) decoded[piece] = 0;
  });
  has_first_piece_ = has_first_piece_ && decoded[0] != 0;
  if (!has_first_piece_) std::ranges::fill(decoded, 0);
  for_each_corner([&](uint32_t piece, uint32_t vertex) {
    if (decoded[piece] == 0) is_known_[vertex] = 0;
  });
  return decoded;
}

std::vector<DetailPiece> pieces_of(const DetailStream& stream) {
  if (!stream.pieces.empty()) return stream.pieces;
  return {{.bytes = static_cast<uint32_t>(stream.bytes.size()),
           .texcoord_bytes = static_cast<uint32_t>(stream.texcoords.bytes.size())}};
}

PieceBytes piece_bytes(std::span<const uint8_t> all, std::span<const DetailPiece> pieces, uint32_t DetailPiece::*size,
                       std::span<const uint8_t> is_decoded) {
  PieceBytes made;
  for (size_t p = 0; p < pieces.size(); ++p) {
    const std::span<const uint8_t> own = all.first(pieces[p].*size);
    all = all.subspan(own.size());
    made.push_back(is_decoded[p] != 0 ? std::optional(own) : std::nullopt);
  }
  return made;
}

}  // namespace papilio
