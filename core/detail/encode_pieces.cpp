#include "detail/encode_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace papilio {
namespace {

/// Margin of the bounds against rounding, a share.
constexpr double rounding_margin = 1e-6;

float rounded_up(double value) {
  return std::nextafter(static_cast<float>(value * (1 + rounding_margin)), std::numeric_limits<float>::infinity());
}

/// Returns, for each piece, an upper bound of the distance by which its residuals move a vertex.
std::vector<float> largest_moves(const DetailLevel& level, const Residuals& residuals, const EdgePieces& pieces) {
  std::vector<double> squared(pieces.count());
  std::vector<int64_t> across(level.topology().edge_count());
  for (size_t c = 0; c < residuals.across.size(); ++c) across[level.curve_edges()[c]] = residuals.across[c];
  for (uint32_t e = 0; e < across.size(); ++e) {
    const auto square = [](int64_t part) { return static_cast<double>(part * part); };
    double sum = square(residuals.along_normal[e]) + square(across[e]);
    if (const auto free = residuals.tangential.find(e); free != residuals.tangential.end())
      sum += square(free->second[0]) + square(free->second[1]);
    squared[pieces.of_edge[e]] = std::max(squared[pieces.of_edge[e]], sum);
  }
  std::vector<float> made(squared.size());
  std::ranges::transform(squared, made.begin(),
                         [&](double s) { return s == 0 ? 0 : rounded_up(std::sqrt(s) * residuals.step); });
  return made;
}

/// Returns, for each piece, the bounding sphere and normal cone of its faces on a surface `levels` levels below the
/// base.
std::vector<PieceBounds> bounds_of(const TriangleMesh& surface, size_t levels, const PieceOrder& order,
                                   uint32_t pieces) {
  // Calls visit(piece, corners, unit normal).
  const auto for_each_face = [&](const auto& visit) {
    for (uint32_t f = 0; f < surface.triangles.size(); ++f) {
      const Triangle& t = surface.triangles[f];
      const std::array<Vec3f, 3> corners{surface.positions[t[0]], surface.positions[t[1]], surface.positions[t[2]]};
      const Vec3d a = to_double(corners[0]);
      const Vec3d area = cross(to_double(corners[1]) - a, to_double(corners[2]) - a);
      const double size = length(area);
      visit(order.piece_of(f >> (2 * levels), pieces), corners, size > 0 ? 1 / size * area : Vec3d{});
    }
  };
  struct Sums {
    Box box = bounding_box({});
    Vec3d normals{};
  };
  std::vector<Sums> sums(pieces);
  for_each_face([&](uint32_t piece, const std::array<Vec3f, 3>& corners, Vec3d normal) {
    Sums& sum = sums[piece];
    for (const Vec3f p : corners)
      for (float Vec3f::*axis : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
        sum.box.min.*axis = std::min(sum.box.min.*axis, p.*axis);
        sum.box.max.*axis = std::max(sum.box.max.*axis, p.*axis);
      }
    sum.normals = sum.normals + normal;
  });
  std::vector<PieceBounds> made(pieces);
  for (uint32_t p = 0; p < pieces; ++p) {
    const double size = length(sums[p].normals);
    made[p].centre = 0.5F * (sums[p].box.min + sums[p].box.max);
    made[p].axis = size > 0 ? to_float(1 / size * sums[p].normals) : Vec3f{0, 0, 1};
    made[p].least_cosine = 1;
  }
  for_each_face([&](uint32_t piece, const std::array<Vec3f, 3>& corners, Vec3d normal) {
    PieceBounds& bounds = made[piece];
    for (const Vec3f p : corners)
      bounds.radius = std::max(bounds.radius, rounded_up(length(to_double(p) - to_double(bounds.centre))));
    if (length(normal) == 0) return;
    const double cosine = dot(normal, to_double(bounds.axis)) - rounding_margin;
    bounds.least_cosine = std::min(bounds.least_cosine, std::max(-1.0F, -rounded_up(-cosine)));
  });
  return made;
}

/// Appends a piece's bytes to `all`, and returns their number.
uint32_t append(std::vector<uint8_t>& all, const std::vector<uint8_t>& piece) {
  all.insert(all.end(), piece.begin(), piece.end());
  return static_cast<uint32_t>(piece.size());
}

std::vector<DetailStream> streams_of(const ResidualFit& fit, const PieceOrder& order,
                                     std::span<const uint32_t> piece_counts, const ValueCoder& code_values) {
  const auto residuals = fit.code(order, piece_counts);
  const std::vector<CodedValues> values = code_values(piece_counts);
  std::vector<DetailStream> made;
  for (size_t l = 0; l < fit.level_count(); ++l) {
    DetailStream& stream = made.emplace_back();
    stream.step = fit.step(l);
    stream.pieces.resize(piece_counts[l]);
    if (!values.empty()) stream.texcoords.step = values[l].step;
    for (uint32_t p = 0; p < piece_counts[l]; ++p) {
      stream.pieces[p].bytes = append(stream.bytes, residuals[l][p]);
      if (stream.texcoords.step > 0)
        stream.pieces[p].texcoord_bytes = append(stream.texcoords.bytes, values[l].pieces[p]);
    }
  }
  return made;
}

}  // namespace

std::vector<DetailStream> encode_pieces(const ResidualFit& fit, const PieceOrder& order, uint64_t piece_bytes,
                                        const ValueCoder& code_values) {
  std::vector<uint32_t> counts(fit.level_count(), 1);
  std::vector<DetailStream> streams = streams_of(fit, order, counts, code_values);
  const auto most = std::min<uint64_t>(order.corners().size() / 3, most_detail_pieces);
  for (size_t l = 0; l < counts.size(); ++l) {
    const uint64_t bytes = streams[l].bytes.size() + streams[l].texcoords.bytes.size();
    counts[l] = static_cast<uint32_t>(std::clamp<uint64_t>((bytes + piece_bytes / 2) / piece_bytes, 1, most));
  }
  if (std::ranges::any_of(counts, [](uint32_t count) { return count > 1; }))
    streams = streams_of(fit, order, counts, code_values);
  const TriangleMesh surface = fit.surface(fit.level_count());
  for (size_t l = 0; l < counts.size(); ++l) {
    std::vector<DetailPiece>& pieces = streams[l].pieces;
    if (pieces.size() == 1) {
      pieces.clear();
      continue;
    }
    const EdgePieces edges = order.edges(fit.level(l).topology(), fit.level(l).number(), counts[l]);
    const std::vector<float> moves = largest_moves(fit.level(l), fit.residuals(l), edges);
    const std::vector<PieceBounds> bounds = bounds_of(surface, fit.level_count(), order, counts[l]);
    for (size_t p = 0; p < pieces.size(); ++p) {
      pieces[p].bounds = bounds[p];
      pieces[p].bounds.largest_move = moves[p];
    }
  }
  return streams;
}

}  // namespace papilio
