#include "detail/face_order.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/sort.h"

namespace papilio {
namespace {

constexpr int bits = 21;  ///< of a coordinate; three make a code

/// Returns a number of `bits` bits with two zeros before each.
uint64_t spread(uint64_t number) {
  number = (number | number << 32U) & 0x001f00000000ffffU;
  number = (number | number << 16U) & 0x001f0000ff0000ffU;
  number = (number | number << 8U) & 0x100f00f00f00f00fU;
  number = (number | number << 4U) & 0x10c30c30c30c30c3U;
  return (number | number << 2U) & 0x1249249249249249U;
}

}  // namespace

TriangleMesh along_morton_curve(TriangleMesh mesh) {
  const Box box = bounding_box(mesh.positions);
  const Vec3d least = to_double(box.min);
  const Vec3d size = to_double(box.max) - least;
  const double largest = std::max({size.x, size.y, size.z});
  if (!(largest > 0)) return mesh;
  const double scale = ((1U << bits) - 1) / (3 * largest);
  std::vector<std::pair<uint64_t, uint32_t>> order(mesh.triangles.size());
  for (uint32_t f = 0; f < order.size(); ++f) {
    Vec3d sum{};
    for (const uint32_t point : mesh.triangles[f]) sum += to_double(mesh.positions[point]) - least;
    const Vec3d at = scale * sum;
    const auto code = [](double coordinate) { return spread(static_cast<uint64_t>(coordinate)); };
    order[f] = {code(at.x) | code(at.y) << 1U | code(at.z) << 2U, f};
  }
  sort_range(order);
  auto triangles = Buffer<Triangle>::for_overwrite(mesh.triangles.size());
  for (size_t i = 0; i < order.size(); ++i) triangles[i] = mesh.triangles[order[i].second];
  mesh.triangles = std::move(triangles);
  return mesh;
}

}  // namespace papilio
