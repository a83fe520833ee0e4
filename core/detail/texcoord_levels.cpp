#include "detail/texcoord_levels.h"

#include <algorithm>
#include <cmath>

#include "detail/seams.h"
#include "papilio/error.h"

namespace papilio {
namespace {

/// A face is no frame where the square of its area is a smaller share of that of the rectangle of its sides.
constexpr float least_relative_area = 1e-6F;

/// Moves of fewer steps are not coded. On a subdivided duck 24 % fewer bytes than with 0.5 had 16 % more error.
constexpr double least_coded = 0.75;

void require_finite(const Buffer<Vec3f>& values) {
  for (const Vec3f c : values)
    if (!(std::abs(c.x) <= coordinate_limit && std::abs(c.y) <= coordinate_limit))
      throw Error(Fault::not_finite, "Detail moves a texture coordinate beyond the largest number: it is damaged.");
}

/// Returns how much a linear function changes along `move`, or along as much of it as lies in the plane of three
/// points. `value`: the function at these. At most the differences between them are added; zero where they are on a
/// line.
Vec3f change_along(Vec3f move, const Vec3f (&point)[3], const Vec3f (&value)[3]) {
  const Vec3f one = point[1] - point[0];
  const Vec3f two = point[2] - point[0];
  const float a = dot(one, one);
  const float b = dot(one, two);
  const float c = dot(two, two);
  const float area = a * c - b * b;
  if (!(area > least_relative_area * (a * c))) return {};
  const float x = dot(one, move);
  const float y = dot(two, move);
  const float along_one = std::clamp((c * x - b * y) / area, -1.0F, 1.0F);
  const float along_two = std::clamp((a * y - b * x) / area, -1.0F, 1.0F);
  return along_one * (value[1] - value[0]) + along_two * (value[2] - value[0]);
}

DetailLevel cut_level(const Mesh& base, CutSurface cut, Buffer<Vec3f>& values, Buffer<uint32_t>& vertices) {
  const std::vector<double>& of_points = base.attributes.attributes.at(0).values;
  values.reserve(cut.half_edge.size());
  vertices.reserve(cut.half_edge.size());
  for (const uint32_t h : cut.half_edge) {
    const double* value = &of_points[size_t{2} * base.attributes.point[h]];
    for (const double v : {value[0], value[1]})
      if (!(std::abs(v) <= coordinate_limit))
        throw Error(Fault::not_finite, "A texture coordinate of the base is beyond 1e18.");
    values.push_back({static_cast<float>(value[0]), static_cast<float>(value[1]), 0});
    vertices.push_back(base.topology.origin[h]);
  }
  return DetailLevel(std::move(cut.topology));
}

}  // namespace

TexcoordLevels::TexcoordLevels(const Mesh& base, const std::vector<uint32_t>& seams)
    : level_(cut_level(base, cut_at_seams(base, seams), values_, vertices_)),
      at_vertex_{Buffer<int32_t>(values_.size()), Buffer<int32_t>(values_.size())} {}

void TexcoordLevels::predict(const Topology& whole, const Buffer<Vec3f>& positions) {
  const Topology& t = level().topology();
  Buffer<Vec3f> cut;
  cut.reserve(size_t{t.vertex_count} + t.edge_count());
  for (const uint32_t v : vertices_) cut.push_back(positions[v]);
  level_.predict(cut);
  level_.predict(values_);
  vertices_.reserve(values_.size());
  for (uint32_t e = 0; e < t.edge_count(); ++e) {
    vertices_.push_back(whole.vertex_count + whole.edge[t.half_edge[e]]);
    correct(e, positions[vertices_.back()] - cut[t.vertex_count + e], positions);
  }
}

/// Moves the coordinates of edge e's new vertex as far as its position is from what the rules within the chart give:
/// by the mean over the edge's faces.
void TexcoordLevels::correct(uint32_t e, Vec3f move, const Buffer<Vec3f>& positions) {
  const Topology& t = level_.topology();
  const uint32_t h = t.half_edge[e];
  Vec3f sum;
  for (const uint32_t side : {h, t.twin[h]}) {
    if (side == none) continue;
    const uint32_t* corner = &t.origin[size_t{3} * Topology::face(side)];
    const Vec3f point[3]{positions[vertices_[corner[0]]], positions[vertices_[corner[1]]],
                         positions[vertices_[corner[2]]]};
    const Vec3f value[3]{values_[corner[0]], values_[corner[1]], values_[corner[2]]};
    sum += change_along(move, point, value);
  }
  values_[t.vertex_count + e] += (t.twin[h] == none ? 1.0F : 0.5F) * sum;
}

void TexcoordLevels::decode(const EdgePieces& pieces, const PieceBytes& bytes, float step) {
  const uint32_t edges = level_.topology().edge_count();
  finish(step > 0 ? decode_texcoord_residuals(level_, pieces, bytes, step, at_vertex_, values_, *models_)
                  : TexcoordResiduals{.u = Buffer<int32_t>(edges), .v = Buffer<int32_t>(edges)},
         step);
}

std::vector<std::vector<uint8_t>> TexcoordLevels::encode(const EdgePieces& pieces, const Buffer<Vec3f>& wanted,
                                                         float step) {
  const Topology& t = level_.topology();
  TexcoordResiduals residuals{.u = Buffer<int32_t>(t.edge_count()), .v = Buffer<int32_t>(t.edge_count())};
  const auto steps = [&](float move) {
    const auto limit = static_cast<double>(largest_residual);
    const double way = std::clamp(double{move} / step, -limit, limit);
    return std::abs(way) < least_coded ? 0 : static_cast<int32_t>(std::lround(way));
  };
  bool is_needed = false;
  for (uint32_t e = 0; e < t.edge_count(); ++e) {
    const Vec3f move = wanted[e] - values_[t.vertex_count + e];
    residuals.u[e] = steps(move.x);
    residuals.v[e] = steps(move.y);
    is_needed = is_needed || residuals.u[e] != 0 || residuals.v[e] != 0;
  }
  std::vector<std::vector<uint8_t>> made;
  if (is_needed) made = encode_texcoord_residuals(level_, pieces, residuals, step, at_vertex_, values_, *models_);
  finish(residuals, is_needed ? step : 0);
  return made;
}

void TexcoordLevels::finish(const TexcoordResiduals& residuals, float step) {
  const Topology& t = level_.topology();
  for (uint32_t e = 0; e < t.edge_count(); ++e) {
    Vec3f& value = values_[t.vertex_count + e];
    value.x += static_cast<float>(residuals.u[e]) * step;
    value.y += static_cast<float>(residuals.v[e]) * step;
  }
  require_finite(values_);
  at_vertex_.u.insert(at_vertex_.u.end(), residuals.u.begin(), residuals.u.end());
  at_vertex_.v.insert(at_vertex_.v.end(), residuals.v.begin(), residuals.v.end());
  is_split_ = true;
}

const DetailLevel& TexcoordLevels::level() {
  if (is_split_) level_ = level_.next();
  is_split_ = false;
  return level_;
}

Buffer<Texcoord> TexcoordLevels::on_half_edges() const {
  const Topology& t = level_.topology();
  Buffer<Texcoord> made;
  made.reserve(t.half_edge_count());
  for (const uint32_t e : t.edge) made.push_back({values_[t.vertex_count + e].x, values_[t.vertex_count + e].y});
  return made;
}

uint64_t TexcoordLevels::bytes() const {
  const Topology& t = level_.topology();
  return t.half_edge_count() * 3 * sizeof(uint32_t) + t.edge_count() * (sizeof(uint32_t) + sizeof(EdgeKind)) +
         values_.size() * (sizeof(Vec3f) + 3 * sizeof(uint32_t));
}

PointAttributes TexcoordLevels::points() {
  PointAttributes made;
  made.point = level().topology().origin;
  made.point_count = static_cast<uint32_t>(vertices_.size());
  Attribute& texcoords = made.attributes.emplace_back(Attribute{.components = 2, .values = {}});
  texcoords.values.reserve(2 * vertices_.size());
  for (size_t v = 0; v < vertices_.size(); ++v) {
    texcoords.values.push_back(values_[v].x);
    texcoords.values.push_back(values_[v].y);
  }
  return made;
}

}  // namespace papilio
