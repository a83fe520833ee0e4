#include "view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/hypotenuse.h"
#include "base/trigonometry.h"
#include "error.h"
#include "four_children.h"
#include "normals.h"
#include "subset.h"

namespace papilio {
namespace {

/// The small positive number of section 3.2.2: the sine of the angle by which a face must be turned past
/// edge-on.
constexpr double away_epsilon = 1e-3;

bool is_finite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void require(bool good, const char* option, const char* what) {
  if (!good) throw Error(Fault::bad_option, what, option);
}

void check(const View& view) {
  require(is_finite(view.eye), "view.eye", "The eye must be three finite numbers.");
  require(is_finite(view.target), "view.target", "The target must be three finite numbers.");
  require(is_finite(view.up), "view.up", "The up direction must be three finite numbers.");
  require(view.fov_y > 0 && view.fov_y < 180, "view.fov_y", "The field of view must lie between 0 and 180 degrees.");
  require(view.viewport[0] > 0 && view.viewport[1] > 0 && std::isfinite(view.viewport[0]) &&
              std::isfinite(view.viewport[1]),
          "view.viewport", "The viewport must be two positive numbers of pixels.");
  require(view.near >= 0 && std::isfinite(view.near), "view.near", "The near plane's distance must not be negative.");
  require(view.edge_pixels >= 0, "view.edge_pixels", "The length in pixels must not be negative.");
  require(view.error_pixels >= 0, "view.error_pixels", "The deviation in pixels must not be negative.");
  for (Vec3d light : view.lights)
    require(length(light) > 0 && std::isfinite(length(light)), "view.lights",
            "Each light must be a direction, three finite numbers that are not all zero.");
}

Vec3d unit(Vec3d v) { return (1 / length(v)) * v; }

enum : uint8_t { is_inside = 1, is_towards = 2, seen = 3 };

/// Which faces the view shows.
class Sight {
 public:
  /// `longest` [V] edges; `box` of the vertices.
  Sight(const Mesh& mesh, const Array<Vec3f>& normals, const FacePlanes& planes, const List<double>& longest,
        const Box& box, const Camera& camera)
      : mesh_(mesh),
        normals_(normals),
        planes_(planes),
        longest_(longest),
        camera_(camera),
        quick_(camera, box),
        through_(camera.planes_through(box)),
        quick_outside_(camera, box, through_),
        inside_(through_ == 0 ? 0 : mesh.topology.vertex_count, unknown) {}

  /// What of the above holds for a face.
  [[nodiscard]] uint8_t of_face(uint32_t f) {
    uint8_t sight = is_face_away(f) ? 0 : is_towards;
    return sight | (is_inside_somewhere(f) ? is_inside : 0);
  }
  /// The same of four faces, the children of one (four_children.h), from their first. Not where planes are kept, nor
  /// before all vertices were looked at.
  void of_four(uint32_t first, uint8_t* sights) const {
    const std::array<uint32_t, 6> vertex = vertices_of_four(&mesh_.topology.origin[size_t{3} * first]);
    std::array<Lanes, 6> p;
    std::array<uint8_t, 6> in;
    for (uint32_t i = 0; i < 6; ++i) {
      p[i] = widen(mesh_.positions[vertex[i]]);
      in[i] = inside_[vertex[i]];
    }
    const FourVectors normals = at(normals_, {first, first + 1, first + 2, first + 3});
    const FourVectors centroids =
        (1.0F / 3) * transposed(p[0] + p[3] + p[5], p[3] + p[1] + p[4], p[5] + p[4] + p[2], p[3] + p[4] + p[5]);
    const auto [are_towards, are_away] = quick_(normals, dot(normals, centroids));
    auto is_away = std::bit_cast<std::array<uint32_t, 4>>(are_away);
    if (!is_all(are_towards | are_away)) [[unlikely]]
      for (uint32_t i = 0; i < 4; ++i) is_away[i] = is_face_away(first + i) ? ~0U : 0;
    put_sight(is_away[0], in[0] | in[3] | in[5], sights);
    put_sight(is_away[1], in[3] | in[1] | in[4], sights + 1);
    put_sight(is_away[2], in[5] | in[4] | in[2], sights + 2);
    put_sight(is_away[3], in[3] | in[4] | in[5], sights + 3);
  }
  [[nodiscard]] bool forgets_planes() const { return planes_.empty(); }
  /// Finds what will be asked of vertices at once, where most of them will be: in their order that costs less.
  void look_at_vertices() {
    if (through_ == 0) inside_.assign(mesh_.topology.vertex_count, is_inside);
    for (uint32_t v = 0; v < inside_.size(); ++v) {
      const Camera::Answer is_outside = quick_outside_(mesh_.positions[v], static_cast<float>(longest_[v]));
      if (is_outside == Camera::Answer::unsure)
        (void)is_vertex_inside(v);
      else
        inside_[v] = is_outside == Camera::Answer::no ? is_inside : 0;
    }
  }

 private:
  static constexpr uint8_t unknown = 2;

  /// `away`: all bits, or none.
  static void put_sight(uint32_t away, int inside, uint8_t* sight) {
    *sight = static_cast<uint8_t>((~away & is_towards) | static_cast<uint32_t>(inside));
  }
  [[nodiscard]] Vec3d position(uint32_t v) const { return to_double(mesh_.positions[v]); }
  [[nodiscard]] bool is_vertex_inside(uint32_t v) {
    if (inside_[v] == unknown) inside_[v] = camera_.is_outside(position(v), longest_[v], through_) ? 0 : is_inside;
    return inside_[v] != 0;
  }
  [[nodiscard]] bool is_inside_somewhere(uint32_t f) {
    if (through_ == 0) return true;
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    const bool are_inside[3] = {is_vertex_inside(corner[0]), is_vertex_inside(corner[1]), is_vertex_inside(corner[2])};
    return are_inside[0] | are_inside[1] | are_inside[2];
  }
  [[nodiscard]] bool is_face_away(uint32_t f) const {
    constexpr float not_known = std::numeric_limits<float>::infinity();
    const float plane = planes_.empty() ? not_known : planes_.get(f);
    if (plane != not_known) {
      const Camera::Answer is_away = quick_(normals_[f], plane);
      if (is_away != Camera::Answer::unsure) return is_away == Camera::Answer::yes;
    }
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    const Vec3d centroid = (1.0 / 3) * (position(corner[0]) + position(corner[1]) + position(corner[2]));
    const Vec3d normal = to_double(normals_[f]);
    if (!planes_.empty()) planes_.put(f, static_cast<float>(dot(normal, centroid)));
    return has_normal(normals_[f]) && camera_.is_away(centroid, normal);
  }

  const Mesh& mesh_;
  const Array<Vec3f>& normals_;
  const FacePlanes& planes_;
  const List<double>& longest_;
  const Camera& camera_;
  const Camera::QuickAway quick_;
  const unsigned through_;  ///< the planes that some of the mesh may be outside of
  const Camera::QuickOutside quick_outside_;
  List<uint8_t> inside_;  ///< [V] is_inside, or 0, or unknown; empty where all are and nobody has looked
};

}  // namespace

Camera::Camera(const View& view) : perspective_(view.projection == Projection::perspective), eye_(view.eye) {
  check(view);
  const double distance = length(view.target - view.eye);
  require(distance > 0 && std::isfinite(distance), "view.target",
          "The target must be another point than the eye, at a distance that can be computed.");
  forward_ = unit(view.target - view.eye);
  require(length(view.up) > 0 && std::isfinite(length(view.up)), "view.up",
          "The up direction must have a length that can be computed.");
  const Vec3d sideways = cross(forward_, unit(view.up));
  require(length(sideways) > 1e-9, "view.up",
          "The up direction must not point along the line of sight. Choose another up.");
  right_ = unit(sideways);
  up_ = cross(right_, forward_);
  near_ = view.near > 0 ? view.near : 1e-3 * distance;

  const double tan_y = tangent_of_degrees(view.fov_y / 2);
  const double tan_x = tan_y * view.viewport[0] / view.viewport[1];
  const double half_height = perspective_ ? tan_y : tan_y * distance;
  pixels_per_unit_ = view.viewport[1] / (2 * half_height);
  const auto side = [&](Vec3d direction, double tangent) {
    if (!perspective_) return Plane{-1.0 * direction, -dot(direction, eye_) - tangent * distance};
    const Vec3d normal = unit(tangent * forward_ - direction);
    return Plane{normal, dot(normal, eye_)};
  };
  planes_ = {side(right_, tan_x), side(-1.0 * right_, tan_x), side(up_, tan_y), side(-1.0 * up_, tan_y),
             Plane{forward_, dot(forward_, eye_) + near_}};
}

bool Camera::is_outside(Vec3d centre, double radius, unsigned planes) const {
  for (unsigned i = 0; i < planes_.size(); ++i)
    if ((planes >> i & 1U) != 0 && dot(planes_[i].normal, centre) - planes_[i].offset < -radius) return true;
  return false;
}

unsigned Camera::planes_through(const Box& box) const {
  constexpr double margin = 1e-9;
  const auto least = [&](const Plane& p) {
    double sum = -p.offset;
    double size = std::abs(p.offset);
    const auto add = [&](double n, double low, double high) {
      sum += std::min(n * low, n * high);
      size += std::abs(n) * std::max(std::abs(low), std::abs(high));
    };
    add(p.normal.x, box.min.x, box.max.x);
    add(p.normal.y, box.min.y, box.max.y);
    add(p.normal.z, box.min.z, box.max.z);
    return sum - margin * size;
  };
  unsigned through = 0;
  for (unsigned i = 0; i < planes_.size(); ++i) through |= least(planes_[i]) > 0 ? 0U : 1U << i;
  return through;
}

double Camera::highest_pixels_per_unit(const Box& box) const {
  constexpr double rounding = 1 + 1e-9;
  double depth = -dot(forward_, eye_);
  const auto add = [&](double n, double low, double high) { depth += std::min(n * low, n * high); };
  add(forward_.x, box.min.x, box.max.x);
  add(forward_.y, box.min.y, box.max.y);
  add(forward_.z, box.min.z, box.max.z);
  return rounding * pixels_per_unit_at(depth);
}

/// The sine is compared as a square, without a root.
bool Camera::is_away(Vec3d point, Vec3d normal) const {
  const Vec3d sight = perspective_ ? point - eye_ : forward_;
  const double along = dot(sight, normal);
  return along > 0 && along * along > away_epsilon * away_epsilon * dot(sight, sight);
}

namespace {

/// What is farther is not looked at in floats.
constexpr double most_in_floats = 1e18;

/// As far from the origin as anything in the box.
Vec3d farthest_corner(const Box& box) {
  return {std::max(std::abs(box.min.x), std::abs(box.max.x)), std::max(std::abs(box.min.y), std::abs(box.max.y)),
          std::max(std::abs(box.min.z), std::abs(box.max.z))};
}

}  // namespace

Camera::QuickOutside::QuickOutside(const Camera& camera, const Box& box, unsigned planes)
    : is_certain_((planes >> near_plane & 1U) == 0) {
  constexpr float nowhere = std::numeric_limits<float>::max();
  double farthest = 0;  // plane from the origin
  for (size_t i = 0; i < 4; ++i) {
    if (std::abs(camera.planes_[i].offset) > most_in_floats) is_certain_ = false;
    const Plane plane = is_certain_ && (planes >> i & 1U) != 0 ? camera.planes_[i] : Plane{{}, -nowhere};
    normals_.x[i] = static_cast<float>(plane.normal.x);
    normals_.y[i] = static_cast<float>(plane.normal.y);
    normals_.z[i] = static_cast<float>(plane.normal.z);
    offsets_[i] = static_cast<float>(plane.offset);
    if (plane.offset != -nowhere) farthest = std::max(farthest, std::abs(plane.offset));
  }
  margin_ = static_cast<float>(2e-6 * (length(farthest_corner(box)) + farthest));
}

Camera::QuickAway::QuickAway(const Camera& camera, const Box& box) : perspective_(camera.perspective_ ? 1 : 0) {
  const Vec3d high = farthest_corner(box);
  from_ = camera.perspective_ ? camera.eye_ : -1.0 * camera.forward_;
  // No less than the distance of anything in the box, and than the products above.
  const double size = length(high) + length(from_);
  rounding_ = 1e-6 * size;
  surely_away_ = rounding_ + 1.001 * away_epsilon * size;
  const bool fits = size < most_in_floats;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  from_in_floats_ = fits ? to_float(from_) : Vec3f{};
  surely_towards_in_floats_ = fits ? static_cast<float>(-rounding_) : -infinity;
  surely_away_in_floats_ = fits ? static_cast<float>(surely_away_) : infinity;
}

double Camera::facing(Vec3d point, Vec3d normal) const {
  if (!perspective_) return -dot(forward_, normal);
  const Vec3d sight = point - eye_;
  const double distance = length(sight);
  return distance > 0 ? -dot(sight, normal) / distance : 0;
}

std::array<double, 2> Camera::project(Vec3d relative) const {
  const double scale = pixels_per_unit_at(dot(forward_, relative));
  return {scale * dot(right_, relative), scale * dot(up_, relative)};
}

double Camera::projected_length(Vec3d a, Vec3d b) const {
  const auto [x, y] = projected_difference(a, b);
  return hypotenuse(x, y);
}

/// What is not near the border is decided by squares, without a root; and in perspective by products with both depths,
/// without a division.
bool Camera::looks_shorter(Vec3d a, Vec3d b, double pixels) const {
  constexpr double rounding = 1e-9;
  const Vec3d from_eye_a = a - eye_;
  const Vec3d from_eye_b = b - eye_;
  const double depth_a = dot(forward_, from_eye_a);
  const double depth_b = dot(forward_, from_eye_b);
  if (perspective_ && depth_a >= near_ && depth_b >= near_ && pixels_per_unit_ < most_pixels_per_unit * near_) {
    const double x = depth_b * dot(right_, from_eye_a) - depth_a * dot(right_, from_eye_b);
    const double y = depth_b * dot(up_, from_eye_a) - depth_a * dot(up_, from_eye_b);
    const double seen = pixels_per_unit_ * pixels_per_unit_ * (x * x + y * y);
    const double border = pixels * depth_a * depth_b * (pixels * depth_a * depth_b);
    if (seen > (1 + rounding) * border) return false;
    if (seen < (1 - rounding) * border) return true;
  }
  return projected_length(a, b) < pixels;
}

std::array<double, 2> Camera::projected_difference(Vec3d a, Vec3d b) const {
  a -= eye_;
  b -= eye_;
  const double depth_a = dot(forward_, a);
  const double depth_b = dot(forward_, b);
  if (depth_a < near_ && depth_b < near_) return {0, 0};
  if (depth_a < near_) a += ((near_ - depth_a) / (depth_b - depth_a)) * (b - a);
  if (depth_b < near_) b += ((near_ - depth_b) / (depth_a - depth_b)) * (a - b);
  const auto [ax, ay] = project(a);
  const auto [bx, by] = project(b);
  return {bx - ax, by - ay};
}

std::vector<bool> hidden_faces(const Mesh& mesh, const Array<Vec3f>& normals, const Camera& camera) {
  const List<double> longest = longest_edges(mesh);
  const FacePlanes none_kept;
  Sight sight(mesh, normals, none_kept, longest, bounding_box(mesh.positions), camera);
  std::vector<bool> hidden(mesh.topology.face_count());
  for (uint32_t f = 0; f < hidden.size(); ++f) hidden[f] = sight.of_face(f) != seen;
  return hidden;
}

List<double> longest_edges(const Mesh& mesh) {
  const Topology& topology = mesh.topology;
  List<double> longest(topology.vertex_count, 0);
  for (uint32_t e = 0; e < topology.edge_count(); ++e) {
    const uint32_t a = topology.origin[topology.half_edge[e]];
    const uint32_t b = topology.tip(topology.half_edge[e]);
    const Vec3d along = to_double(mesh.positions[b]) - to_double(mesh.positions[a]);
    const double squared = dot(along, along);
    longest[a] = std::max(longest[a], squared);
    longest[b] = std::max(longest[b], squared);
  }
  for (double& l : longest) l = std::sqrt(l);
  return longest;
}

List<double> longest_edges_below(const Topology& parents, const Array<Vec3f>& positions, const List<uint32_t>* faces) {
  const Subset of(parents.face_count(), faces);
  List<double> longest(positions.size(), 0);
  for (uint32_t k = 0; k < of.size(); ++k) {
    const uint32_t* corner = &parents.origin[size_t{3} * of[k]];
    const uint32_t* edge = &parents.edge[size_t{3} * of[k]];
    const uint32_t first_new = parents.vertex_count;
    const std::array<uint32_t, 6> vertex{corner[0],           corner[1],           corner[2],
                                         first_new + edge[0], first_new + edge[1], first_new + edge[2]};
    std::array<Vec3d, 6> p;
    for (uint32_t i = 0; i < 6; ++i) p[i] = to_double(positions[vertex[i]]);
    std::array<double, 6> squared{};
    visit_edges_of_four([&](uint32_t /*half_edge*/, uint32_t from, uint32_t to) {
      const Vec3d along = p[to] - p[from];
      const double squared_length = dot(along, along);
      squared[from] = std::max(squared[from], squared_length);
      squared[to] = std::max(squared[to], squared_length);
    });
    for (uint32_t i = 0; i < 6; ++i) longest[vertex[i]] = std::max(longest[vertex[i]], squared[i]);
  }
  for (double& l : longest) l = std::sqrt(l);
  return longest;
}

EdgeMarks edges_shown(const Mesh& mesh, const Array<Vec3f>& normals, const FacePlanes& planes,
                      const List<double>& longest, const Box& box, const Camera& camera, const Region& region) {
  const Topology& topology = mesh.topology;
  Sight sight(mesh, normals, planes, longest, box, camera);
  List<uint8_t> seen_by(topology.edge_count(), 0);
  for (uint32_t f : region.faces) {
    const uint8_t of_face = sight.of_face(f);
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) seen_by[topology.edge[h]] |= of_face;
  }
  EdgeMarks marks(topology.edge_count(), 0);
  for (uint32_t e = 0; e < marks.size(); ++e) marks[e] = seen_by[e] == seen ? region.has_edge[e] : 0;
  return marks;
}

/// What was found of faces already.
class EdgesShown::Memory {
 public:
  Memory(const Mesh& mesh, Sight sight, const List<uint32_t>& shared)
      : mesh_(mesh.topology), sight_(std::move(sight)), of_face_(mesh_.face_count(), unknown) {
    if (shared.empty()) return;
    of_shared_.assign(mesh_.edge_count(), 0);
    for (uint32_t h : shared) of_shared_[mesh_.edge[h]] |= of_face(Topology::face(h));
  }

  [[nodiscard]] bool is_shown(uint32_t e) {
    if (!of_shared_.empty() && mesh_.kind[e] == EdgeKind::shared) return of_shared_[e] == seen;
    const uint32_t h = mesh_.half_edge[e];
    const uint32_t t = mesh_.twin[h];
    return (of_face(Topology::face(h)) | of_face(Topology::face(t != none ? t : h))) == seen;
  }

  /// The faces are all those at the edges.
  void keep_shown_once_all_are_looked_at(const Region& region, List<uint32_t>& edges) {
    look_at(region);
    keep_if(edges, [this, has_shared = !of_shared_.empty()](uint32_t e) {
      const uint32_t h = mesh_.half_edge[e];
      const uint32_t t = mesh_.twin[h];
      const int sight = of_face_[Topology::face(h)] | of_face_[Topology::face(t != none ? t : h)];
      return has_shared ? is_shown(e) : sight == seen;
    });
  }

 private:
  static constexpr uint8_t unknown = 255;
  void look_at(const Region& region) {
    const List<uint32_t>& faces = region.faces;
    const bool are_many = faces.size() > mesh_.vertex_count;
    if (are_many) sight_.look_at_vertices();
    if (are_many && region.is_in_fours && sight_.forgets_planes())
      for (size_t i = 0; i < faces.size(); i += 4) sight_.of_four(faces[i], &of_face_[faces[i]]);
    else
      for (uint32_t f : faces) (void)of_face(f);
  }
  [[nodiscard]] uint8_t of_face(uint32_t f) {
    if (of_face_[f] == unknown) of_face_[f] = sight_.of_face(f);
    return of_face_[f];
  }

  const Topology& mesh_;
  Sight sight_;
  List<uint8_t> of_face_;    ///< [F] or unknown
  List<uint8_t> of_shared_;  ///< [E] of shared edges' faces together; empty where there are none
};

EdgesShown::EdgesShown() = default;
EdgesShown::EdgesShown(const Mesh& mesh, const Array<Vec3f>& normals, const FacePlanes& planes,
                       const List<double>& longest, const Box& box, const Camera& camera, const List<uint32_t>& shared)
    : memory_(std::make_unique<Memory>(mesh, Sight(mesh, normals, planes, longest, box, camera), shared)) {}
EdgesShown::EdgesShown(EdgesShown&& other) noexcept = default;
EdgesShown& EdgesShown::operator=(EdgesShown&& other) noexcept = default;
EdgesShown::~EdgesShown() = default;

bool EdgesShown::operator[](uint32_t edge) const { return memory_ == nullptr || memory_->is_shown(edge); }

void EdgesShown::keep_shown(const Region& region, List<uint32_t>& edges) const {
  if (memory_ == nullptr) return;
  Memory& memory = *memory_;
  constexpr size_t many = 3;  // so many for four faces: about every second edge
  if (edges.size() * 4 > region.faces.size() * many)
    memory.keep_shown_once_all_are_looked_at(region, edges);
  else
    keep_if(edges, [&](uint32_t e) { return memory.is_shown(e); });
}

bool looks_long(const Mesh& mesh, uint32_t edge, const Camera& camera, double edge_pixels) {
  if (edge_pixels == 0) return true;
  const uint32_t h = mesh.topology.half_edge[edge];
  return !camera.looks_shorter(to_double(mesh.positions[mesh.topology.origin[h]]),
                               to_double(mesh.positions[mesh.topology.tip(h)]), edge_pixels);
}

void keep_long(const Mesh& mesh, const Camera& camera, double edge_pixels, List<uint32_t>& edges) {
  if (edge_pixels == 0) return;
  keep_if(edges, [&](uint32_t e) { return looks_long(mesh, e, camera, edge_pixels); });
}

void cull_by_view(const Mesh& mesh, const Array<Vec3f>& normals, const Camera& camera, double edge_pixels,
                  EdgeMarks& marks) {
  const EdgeMarks shown = edges_shown(mesh, normals, {}, longest_edges(mesh), bounding_box(mesh.positions), camera,
                                      whole_region(mesh.topology));
  for (uint32_t e = 0; e < marks.size(); ++e)
    if (marks[e] != 0 && (shown[e] == 0 || !looks_long(mesh, e, camera, edge_pixels))) marks[e] = 0;
}

}  // namespace papilio
