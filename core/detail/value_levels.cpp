#include "detail/value_levels.h"

#include <algorithm>
#include <cmath>

#include "detail/seams.h"
#include "papilio/error.h"

namespace papilio {
namespace {

/// Lower bound of a face's squared area, relative to the rectangle of its sides, below which it defines no frame.
constexpr float least_relative_area = 1e-6F;

/// Lower bound of coded moves, in steps. On a subdivided duck it takes 24 % fewer bytes than 0.5, with 16 % more error.
constexpr double least_coded = 0.75;

/// Step of colours, in steps of texture coordinates: colours are in 0..255.
constexpr float colour_steps = 2048;

bool is_finite(float number) { return std::abs(number) <= coordinate_limit; }

void require_finite(const Buffer<Vec3f>& values) {
  for (const Vec3f c : values)
    if (!is_finite(c.x) || !is_finite(c.y) || !is_finite(c.z))
      throw Error(Fault::not_finite,
                  "Detail moves a texture coordinate or a colour beyond the largest number: it is damaged.");
}

float& component(Vec3f& value, uint32_t number) { return number == 0 ? value.x : number == 1 ? value.y : value.z; }

/// Returns the change of a linear function along `move`, projected onto the plane of three points. `value`: the
/// function at the points. The change is clamped to one difference along each side; zero for collinear points.
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

DetailLevel cut_level(const Mesh& base, CutSurface cut, std::vector<ValueLevels::Track>& tracks,
                      Buffer<uint32_t>& vertices) {
  vertices.reserve(cut.half_edge.size());
  for (const uint32_t h : cut.half_edge) vertices.push_back(base.topology.origin[h]);
  for (const Attribute& attribute : base.attributes.attributes) {
    if (attribute.components == 1) continue;
    ValueLevels::Track& track = tracks.emplace_back();
    track.components = attribute.components;
    track.values.reserve(cut.half_edge.size());
    for (const uint32_t h : cut.half_edge) {
      const double* value = &attribute.values[size_t{attribute.components} * base.attributes.point[h]];
      Vec3f made;
      for (uint32_t c = 0; c < attribute.components; ++c) {
        if (!(std::abs(value[c]) <= coordinate_limit))
          throw Error(Fault::not_finite, "A texture coordinate or a colour of the base is beyond 1e18.");
        component(made, c) = static_cast<float>(value[c]);
      }
      track.values.push_back(made);
    }
  }
  return DetailLevel(std::move(cut.topology));
}

}  // namespace

ValueLevels::ValueLevels(const Mesh& base, const std::vector<uint32_t>& seams)
    : level_(cut_level(base, cut_at_seams(base, seams), tracks_, vertices_)) {
  size_t components = 0;
  for (const Track& track : tracks_) components += track.components;
  models_.resize(components);
  at_vertex_.assign(components, Buffer<int32_t>(vertices_.size()));
}

void ValueLevels::predict(const Topology& whole, const Buffer<Vec3f>& positions) {
  const Topology& t = level().topology();
  Buffer<Vec3f> cut;
  cut.reserve(size_t{t.vertex_count} + t.edge_count());
  for (const uint32_t v : vertices_) cut.push_back(positions[v]);
  level_.predict(cut);
  for (Track& track : tracks_) level_.predict(track.values);
  vertices_.reserve(size_t{t.vertex_count} + t.edge_count());
  for (uint32_t e = 0; e < t.edge_count(); ++e) {
    vertices_.push_back(whole.vertex_count + whole.edge[t.half_edge[e]]);
    correct(e, positions[vertices_.back()] - cut[t.vertex_count + e], positions);
  }
}

// Corrects the values of edge e's new vertex, whose position differs by `move` from the rules' position within the
// chart: by the mean change over the edge's faces.
void ValueLevels::correct(uint32_t e, Vec3f move, const Buffer<Vec3f>& positions) {
  const Topology& t = level_.topology();
  const uint32_t h = t.half_edge[e];
  for (Track& track : tracks_) {
    Vec3f sum;
    for (const uint32_t side : {h, t.twin[h]}) {
      if (side == none) continue;
      const uint32_t* corner = &t.origin[size_t{3} * Topology::face(side)];
      const Vec3f point[3]{positions[vertices_[corner[0]]], positions[vertices_[corner[1]]],
                           positions[vertices_[corner[2]]]};
      const Vec3f value[3]{track.values[corner[0]], track.values[corner[1]], track.values[corner[2]]};
      sum += change_along(move, point, value);
    }
    track.values[t.vertex_count + e] += (t.twin[h] == none ? 1.0F : 0.5F) * sum;
  }
}

std::vector<ValueChannel> ValueLevels::channels(float step) const {
  std::vector<ValueChannel> made;
  for (const Track& track : tracks_)
    made.resize(made.size() + track.components, {&track.values, track.components == 3 ? colour_steps * step : step});
  return made;
}

ValueResiduals ValueLevels::no_residuals() {
  ValueResiduals made(models_.size(), Buffer<int32_t>(level().topology().edge_count()));
  return made;
}

void ValueLevels::decode(const EdgePieces& pieces, const PieceBytes& bytes, float step) {
  finish(step > 0 ? decode_value_residuals(level_, pieces, channels(step), bytes, at_vertex_, models_) : no_residuals(),
         step);
}

std::vector<std::vector<uint8_t>> ValueLevels::encode(const EdgePieces& pieces, std::span<const Buffer<Vec3f>> wanted,
                                                      float step) {
  const Topology& t = level_.topology();
  const std::vector<ValueChannel> channels = this->channels(step);
  ValueResiduals residuals = no_residuals();
  bool is_needed = false;
  size_t channel = 0;
  for (size_t i = 0; i < tracks_.size(); ++i)
    for (uint32_t c = 0; c < tracks_[i].components; ++c, ++channel)
      for (uint32_t e = 0; e < t.edge_count(); ++e) {
        Vec3f move = wanted[i][e] - tracks_[i].values[t.vertex_count + e];
        const auto limit = static_cast<double>(largest_residual);
        const double way = std::clamp(double{component(move, c)} / channels[channel].step, -limit, limit);
        if (std::abs(way) < least_coded) continue;
        residuals[channel][e] = static_cast<int32_t>(std::lround(way));
        is_needed = true;
      }
  std::vector<std::vector<uint8_t>> made;
  if (is_needed) made = encode_value_residuals(level_, pieces, channels, residuals, at_vertex_, models_);
  finish(residuals, is_needed ? step : 0);
  return made;
}

void ValueLevels::finish(const ValueResiduals& residuals, float step) {
  const Topology& t = level_.topology();
  const std::vector<ValueChannel> channels = this->channels(step);
  size_t channel = 0;
  for (Track& track : tracks_) {
    for (uint32_t c = 0; c < track.components; ++c, ++channel)
      for (uint32_t e = 0; e < t.edge_count(); ++e)
        component(track.values[t.vertex_count + e], c) +=
            static_cast<float>(residuals[channel][e]) * channels[channel].step;
    require_finite(track.values);
  }
  for (size_t i = 0; i < at_vertex_.size(); ++i)
    at_vertex_[i].insert(at_vertex_[i].end(), residuals[i].begin(), residuals[i].end());
  is_split_ = true;
}

const DetailLevel& ValueLevels::level() {
  if (is_split_) level_ = level_.next();
  is_split_ = false;
  return level_;
}

template <size_t Components>
Buffer<std::array<float, Components>> ValueLevels::on_half_edges() const {
  Buffer<std::array<float, Components>> made;
  const auto track = std::ranges::find(tracks_, Components, &Track::components);
  if (track == tracks_.end()) return made;
  const Topology& t = level_.topology();
  made.reserve(t.half_edge_count());
  for (const uint32_t e : t.edge) {
    const Vec3f value = track->values[t.vertex_count + e];
    if constexpr (Components == 2)
      made.push_back({value.x, value.y});
    else
      made.push_back({value.x, value.y, value.z});
  }
  return made;
}
template Buffer<Texcoord> ValueLevels::on_half_edges() const;
template Buffer<Colour> ValueLevels::on_half_edges() const;

uint64_t ValueLevels::bytes() const {
  const Topology& t = level_.topology();
  return t.half_edge_count() * 3 * sizeof(uint32_t) + t.edge_count() * (sizeof(uint32_t) + sizeof(EdgeKind)) +
         vertices_.size() * (tracks_.size() * sizeof(Vec3f) + (1 + models_.size()) * sizeof(uint32_t));
}

PointAttributes ValueLevels::points() {
  PointAttributes made;
  made.point = level().topology().origin;
  made.point_count = static_cast<uint32_t>(vertices_.size());
  for (const Track& track : tracks_) {
    Attribute& attribute = made.attributes.emplace_back(Attribute{.components = track.components, .values = {}});
    attribute.values.reserve(track.components * vertices_.size());
    for (const Vec3f value : track.values) {
      attribute.values.push_back(value.x);
      attribute.values.push_back(value.y);
      if (track.components == 3) attribute.values.push_back(value.z);
    }
  }
  return made;
}

}  // namespace papilio
