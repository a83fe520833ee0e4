#include "tests/support/rasteriser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/mesh/normals.h"

namespace papilio::test {
namespace {

Vec3d unit(Vec3d v) { return (1 / length(v)) * v; }

/// A vertex on the raster: x right and y down in samples, and a nearness that is linear on the raster.
struct Corner {
  double x, y;
  double nearness;  ///< 1 / depth in perspective, else -depth
  bool visible;     ///< not nearer than the near plane
};

/// A raster of samples. Its projection is independent of Camera, so that each checks the other.
class Raster {
 public:
  Raster(const View& view, uint32_t samples)
      : view_(view),
        width_(static_cast<uint32_t>(view.viewport[0]) * samples),
        height_(static_cast<uint32_t>(view.viewport[1]) * samples),
        forward_(unit(view.target - view.eye)),
        right_(unit(cross(forward_, view.up))),
        down_(cross(forward_, right_)),
        nearness_(size_t{width_} * height_, -std::numeric_limits<double>::infinity()),
        grey_(nearness_.size(), 0) {
    const double distance = length(view.target - view.eye);
    near_ = view.near > 0 ? view.near : 1e-3 * distance;
    scale_ = height_ / (2 * std::tan(view.fov_y * std::numbers::pi / 360));
    if (!perspective()) scale_ /= distance;
    for (Vec3d light : view.lights) lights_.push_back(unit(light));
  }

  [[nodiscard]] Corner project(Vec3d p) const {
    const Vec3d from_eye = p - view_.eye;
    const double depth = dot(from_eye, forward_);
    const double scale = perspective() ? scale_ / depth : scale_;
    return {width_ / 2.0 + scale * dot(from_eye, right_), height_ / 2.0 + scale * dot(from_eye, down_),
            perspective() ? 1 / depth : -depth, depth >= near_};
  }

  void draw(const std::array<Corner, 3>& c, const std::array<Vec3d, 3>& normals) {
    if (!c[0].visible || !c[1].visible || !c[2].visible) return;
    const double area = side(c[0], c[1], c[2].x, c[2].y);
    if (!(area > 0)) return;
    const auto [x0, x1] = samples_between(std::minmax({c[0].x, c[1].x, c[2].x}), width_);
    const auto [y0, y1] = samples_between(std::minmax({c[0].y, c[1].y, c[2].y}), height_);
    for (uint32_t y = y0; y < y1; ++y) {
      for (uint32_t x = x0; x < x1; ++x) {
        std::array<double, 3> share{};
        for (size_t i = 0; i < 3; ++i) share[i] = side(c[(i + 1) % 3], c[(i + 2) % 3], x + 0.5, y + 0.5) / area;
        if (share[0] < 0 || share[1] < 0 || share[2] < 0) continue;
        const double nearness = share[0] * c[0].nearness + share[1] * c[1].nearness + share[2] * c[2].nearness;
        double& nearest = nearness_[size_t{y} * width_ + x];
        if (nearness <= nearest) continue;
        nearest = nearness;
        Vec3d normal;
        for (size_t i = 0; i < 3; ++i) normal += (perspective() ? share[i] * c[i].nearness : share[i]) * normals[i];
        grey_[size_t{y} * width_ + x] = shade(normal);
      }
    }
  }

  [[nodiscard]] Image image(uint32_t samples) const {
    Image image{width_ / samples, height_ / samples, {}};
    image.grey.resize(size_t{image.width} * image.height);
    for (uint32_t y = 0; y < height_; ++y)
      for (uint32_t x = 0; x < width_; ++x)
        image.grey[size_t{y / samples} * image.width + x / samples] += grey_[size_t{y} * width_ + x];
    for (float& grey : image.grey) grey /= static_cast<float>(samples * samples);
    return image;
  }

 private:
  [[nodiscard]] bool perspective() const { return view_.projection == Projection::perspective; }

  /// Returns twice the signed area of the triangle a, b, (x, y): positive if counter-clockwise in the picture.
  static double side(const Corner& a, const Corner& b, double x, double y) {
    return (b.y - a.y) * (x - a.x) - (b.x - a.x) * (y - a.y);
  }

  /// Returns the samples in a range, clipped to the raster. Samples are at half-integers.
  static std::pair<uint32_t, uint32_t> samples_between(std::pair<double, double> range, uint32_t size) {
    const auto sample = [&](double x) {
      return static_cast<uint32_t>(std::clamp<double>(std::ceil(x - 0.5), 0, size));
    };
    return {sample(range.first), sample(range.second)};
  }

  [[nodiscard]] float shade(Vec3d normal) const {
    double sum = 0;
    for (Vec3d light : lights_) sum += std::max(0.0, dot(normal, light));
    return length(normal) > 0 ? static_cast<float>(std::min(1.0, sum / length(normal))) : 0;
  }

  const View& view_;
  uint32_t width_, height_;
  Vec3d forward_, right_, down_;
  double near_ = 0, scale_ = 0;
  Buffer<Vec3d> lights_;
  std::vector<double> nearness_;
  std::vector<float> grey_;
};

}  // namespace

View overview(const Mesh& mesh, double width, double height) {
  const Box box = bounding_box(mesh.positions);
  View view;
  view.target = box.centre();
  view.eye = view.target + box.diagonal() * Vec3d{0.9, 0.65, 1.2};
  view.fov_y = 38;
  view.viewport = {width, height};
  return view;
}

Image render(const Mesh& mesh, const View& view, uint32_t samples) {
  Raster raster(view, samples);
  const Buffer<Vec3f> normals = vertex_normals(mesh);
  for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) {
    std::array<Corner, 3> corners{};
    std::array<Vec3d, 3> at_corners;
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t v = mesh.topology.origin[3 * f + i];
      corners[i] = raster.project(to_double(mesh.positions[v]));
      at_corners[i] = to_double(normals[v]);
    }
    raster.draw(corners, at_corners);
  }
  return raster.image(samples);
}

double psnr(const Image& a, const Image& b) {
  double sum = 0;
  for (size_t i = 0; i < a.grey.size(); ++i) {
    const double difference = double{a.grey[i]} - double{b.grey[i]};
    sum += difference * difference;
  }
  return -10 * std::log10(sum / static_cast<double>(a.grey.size()));
}

}  // namespace papilio::test
