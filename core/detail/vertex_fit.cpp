#include "detail/vertex_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "detail/surface_samples.h"

namespace papilio {
namespace {

/// Weight that holds a vertex in its place, a share of the sum of its own weights.
constexpr double hold = 0.01;
constexpr int sweeps_of_moves = 40, sweeps_on_grid = 6;
/// Lower bound of the cosine between a face's normals before and after a move.
constexpr double least_cosine_of_turned = 0.3;
/// Lower bound of a distance whose direction is not rounding, a share of the diagonal.
constexpr double least_direction = 1e-8;
/// Lower bound of the sine of an angle of a triangle that has an area, squared.
constexpr double least_squared_sine = 1e-14;
/// With fewer, vertices of small faces would follow one sample too far.
constexpr uint32_t least_samples_a_face = 4;
/// Halvings of moves that lead too far; the last one undoes them.
constexpr int most_retreats = 4;
/// Upper bound of a move, in RMS distances.
constexpr double most_move = 3;

/// Returns the shares of a triangle's corners in a point of its plane.
std::array<double, 3> shares_of(const TriangleCorners& t, Vec3d p) {
  const Vec3d ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double aa = dot(ab, ab), cc = dot(ac, ac), both = dot(ab, ac);
  const double determinant = aa * cc - both * both;
  if (!(determinant > least_squared_sine * aa * cc)) return {1.0 / 3, 1.0 / 3, 1.0 / 3};
  const double v = (cc * dot(ab, ap) - both * dot(ac, ap)) / determinant;
  const double w = (aa * dot(ac, ap) - both * dot(ab, ap)) / determinant;
  return {1 - v - w, v, w};
}

double area_of(const TriangleCorners& c) { return length(cross(c.b - c.a, c.c - c.a)); }

}  // namespace

void VertexFit::Block::add(Vec3d u, double weight) {
  xx += weight * u.x * u.x;
  xy += weight * u.x * u.y;
  xz += weight * u.x * u.z;
  yy += weight * u.y * u.y;
  yz += weight * u.y * u.z;
  zz += weight * u.z * u.z;
}

Vec3d VertexFit::Block::operator*(Vec3d v) const {
  return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
}

Vec3d VertexFit::Block::solve(Vec3d right, double damping) const {
  const Vec3d x{xx + damping, xy, xz}, y{xy, yy + damping, yz}, z{xz, yz, zz + damping};
  const Vec3d minors = cross(y, z);
  const double determinant = dot(x, minors);
  if (!(determinant > 0)) return {};
  return (1 / determinant) * (right.x * minors + right.y * cross(z, x) + right.z * cross(x, y));
}

VertexFit::VertexFit(const SurfaceTree& original, const TriangleMesh& mesh, uint32_t samples, Poller poller)
    : original_(original),
      diagonal_(bounding_box(original.surface().positions).diagonal()),
      samples_(samples),
      poller_(std::move(poller)) {
  faces_.assign(mesh.triangles.begin(), mesh.triangles.end());
  for (const Vec3f& p : mesh.positions) places_.push_back(to_double(p));
  first_places_ = places_;
  connect();
}

TriangleMesh VertexFit::mesh() const {
  TriangleMesh made;
  for (const Vec3d& p : places_) made.positions.push_back(to_float(p));
  for (const Triangle& t : faces_) made.triangles.push_back(t);
  return made;
}

void VertexFit::connect() {
  std::vector<std::vector<uint32_t>> around(places_.size()), faces(places_.size());
  for (uint32_t f = 0; f < faces_.size(); ++f)
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t v = faces_[f][i];
      faces[v].push_back(f);
      around[v].push_back(faces_[f][(i + 1) % 3]);
      around[v].push_back(faces_[f][(i + 2) % 3]);
    }
  first_.assign(1, 0);
  first_face_.assign(1, 0);
  for (uint32_t v = 0; v < places_.size(); ++v) {
    std::ranges::sort(around[v]);
    around[v].erase(std::unique(around[v].begin(), around[v].end()), around[v].end());
    neighbours_.insert(neighbours_.end(), around[v].begin(), around[v].end());
    first_.push_back(static_cast<uint32_t>(neighbours_.size()));
    faces_of_.insert(faces_of_.end(), faces[v].begin(), faces[v].end());
    first_face_.push_back(static_cast<uint32_t>(faces_of_.size()));
  }
}

void VertexFit::measure() {
  if (std::exchange(is_measured_, true)) return;
  own_.assign(places_.size(), {});
  shared_.assign(neighbours_.size(), {});
  pulls_.assign(places_.size(), {});
  const SurfaceTree surface(mesh());
  const double of_original = 1.0 / samples_;
  double sum = 0;
  for_each_sample(original_, samples_, [&](uint32_t, Vec3d point) {
    poller_.step();
    const Nearest near = surface.nearest(point);
    sum += of_original * near.squared_distance;
    add_sample(near.face, near.point, point, surface.unit_normal(near.face), of_original);
  });
  double total = 0;
  for (uint32_t f = 0; f < faces_.size(); ++f) total += area_of(surface.corners(f));
  for (uint32_t f = 0; f < faces_.size(); ++f) {
    const TriangleCorners c = surface.corners(f);
    const double share = total > 0 ? area_of(c) / total : 0;
    const uint32_t count = std::max(least_samples_a_face, static_cast<uint32_t>(share * samples_));
    for (uint32_t i = 0; i < count; ++i) {
      poller_.step();
      const Vec3d point = sample_of(c, i);
      const Nearest near = original_.nearest(point);
      add_sample(f, point, near.point, original_.unit_normal(near.face), share / count);
    }
  }
  rms_ = std::sqrt(sum);
}

void VertexFit::add_sample(uint32_t face, Vec3d at, Vec3d to, Vec3d normal, double weight) {
  const Triangle& t = faces_[face];
  const std::array<double, 3> shares = shares_of({places_[t[0]], places_[t[1]], places_[t[2]]}, at);
  const double distance = length(to - at);
  const Vec3d u = distance > least_direction * diagonal_ ? (1 / distance) * (to - at) : normal;
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t v = t[i];
    own_[v].add(u, weight * shares[i] * shares[i]);
    pulls_[v] += (weight * shares[i] * distance) * u;
    for (size_t j = 0; j < 3; ++j) {
      if (i == j) continue;
      const auto begin = neighbours_.begin() + first_[v], end = neighbours_.begin() + first_[v + 1];
      const auto found = std::lower_bound(begin, end, t[j]);
      shared_[static_cast<size_t>(found - neighbours_.begin())].add(u, weight * shares[i] * shares[j]);
    }
  }
}

Vec3d VertexFit::pull_on(uint32_t v, const std::vector<Vec3d>& moves) const {
  Vec3d pull = pulls_[v];
  for (uint32_t n = first_[v]; n < first_[v + 1]; ++n) pull += -1.0 * (shared_[n] * moves[neighbours_[n]]);
  return pull;
}

bool VertexFit::turns_face(uint32_t v, Vec3d place, const std::vector<Vec3d>& places) const {
  for (uint32_t i = first_face_[v]; i < first_face_[v + 1]; ++i) {
    const Triangle& t = faces_[faces_of_[i]];
    const auto moved = [&](uint32_t w) { return w == v ? place : places[w]; };
    const Vec3d before = cross(places_[t[1]] - places_[t[0]], places_[t[2]] - places_[t[0]]);
    const Vec3d after = cross(moved(t[1]) - moved(t[0]), moved(t[2]) - moved(t[0]));
    if (!(dot(before, after) > least_cosine_of_turned * length(before) * length(after))) return true;
  }
  return false;
}

void VertexFit::improve(int passes) {
  for (int pass = 0; pass < passes; ++pass) improve_once();
}

void VertexFit::improve_once() {
  measure();
  is_measured_ = false;
  std::vector<Vec3d> moves(places_.size());
  for (int sweep = 0; sweep < sweeps_of_moves; ++sweep) {
    poller_.now();
    for (uint32_t v = 0; v < places_.size(); ++v) {
      moves[v] = own_[v].solve(pull_on(v, moves), hold * own_[v].trace());
      const double size = length(moves[v]);
      if (size > most_move * rms_) moves[v] = (most_move * rms_ / size) * moves[v];
    }
  }
  std::vector<Vec3d> places = places_;
  for (uint32_t v = 0; v < places_.size(); ++v)
    if (!turns_face(v, places_[v] + moves[v], places)) places[v] = places_[v] + moves[v];
  places_ = std::move(places);
}

std::vector<bool> VertexFit::far_vertices(double most) const {
  std::vector<bool> is_far(places_.size());
  const SurfaceTree surface(mesh());
  const double squared_most = most * most;
  const auto mark = [&](uint32_t face) {
    for (const uint32_t v : faces_[face]) is_far[v] = true;
  };
  const auto look_from_original = [&](Vec3d point) {
    poller_.step();
    const Nearest near = surface.nearest(point);
    if (near.squared_distance > squared_most) mark(near.face);
  };
  for_each_sample(original_, samples_, [&](uint32_t, Vec3d point) { look_from_original(point); });
  for (const Vec3f& p : original_.surface().positions) look_from_original(to_double(p));
  const auto is_far_from_original = [&](Vec3d point) {
    poller_.step();
    return original_.nearest(point).squared_distance > squared_most;
  };
  for_each_sample(surface, samples_, [&](uint32_t face, Vec3d point) {
    if (is_far_from_original(point)) mark(face);
  });
  for (uint32_t v = 0; v < places_.size(); ++v)
    if (is_far_from_original(places_[v]))
      for (uint32_t i = first_face_[v]; i < first_face_[v + 1]; ++i) mark(faces_of_[i]);
  return is_far;
}

void VertexFit::retreat(double most) {
  for (int i = 1; i <= most_retreats; ++i) {
    const std::vector<bool> is_far = far_vertices(most);
    bool is_moved = false;
    std::vector<Vec3d> places = places_;
    for (uint32_t v = 0; v < places_.size(); ++v) {
      if (!is_far[v] || places_[v] == first_places_[v]) continue;
      const double share = i < most_retreats ? 0.5 : 1;
      const Vec3d place = places_[v] + share * (first_places_[v] - places_[v]);
      if (turns_face(v, place, places)) continue;
      places[v] = place;
      is_moved = true;
    }
    if (!is_moved) return;
    places_ = std::move(places);
    is_measured_ = false;
  }
}

TriangleMesh VertexFit::on_grid(const PositionGrid& grid) {
  measure();
  std::vector<Vec3d> moves, places;
  const Vec3d origin = to_double(grid.origin);
  const double step = grid.step;
  const auto rounded = [&](double x) { return step * std::floor(x / step + 0.5); };
  for (const Vec3d& p : places_) {
    const Vec3d from = p - origin;
    places.push_back(origin + Vec3d{rounded(from.x), rounded(from.y), rounded(from.z)});
    moves.push_back(places.back() - p);
  }
  for (int sweep = 0; sweep < sweeps_on_grid; ++sweep) {
    poller_.now();
    bool is_changed = false;
    for (uint32_t v = 0; v < places_.size(); ++v) {
      const Vec3d pull = pull_on(v, moves);
      const double damping = hold * own_[v].trace();
      const auto energy = [&](Vec3d move) {
        return 0.5 * dot(move, own_[v] * move) + 0.5 * damping * dot(move, move) - dot(pull, move);
      };
      const Vec3d at = moves[v];
      double best = energy(at);
      Vec3d best_move = at;
      for (int i = 0; i < 27; ++i) {
        const std::array<int, 3> steps{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        const Vec3d move = at + step * Vec3d{1.0 * steps[0], 1.0 * steps[1], 1.0 * steps[2]};
        const double value = energy(move);
        if (!(value < best) || turns_face(v, places_[v] + move, places)) continue;
        best = value;
        best_move = move;
      }
      if (best_move == at) continue;
      moves[v] = best_move;
      places[v] = places_[v] + best_move;
      is_changed = true;
    }
    if (!is_changed) break;
  }
  TriangleMesh made = mesh();
  for (uint32_t v = 0; v < places.size(); ++v) made.positions[v] = to_float(places[v]);
  return made;
}

}  // namespace papilio
