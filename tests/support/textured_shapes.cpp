#include "tests/support/textured_shapes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/shapes.h"

namespace papilio::test {

TriangleMesh with_texcoords(const TriangleMesh& plain,
                            const std::function<Texcoord(const Triangle&, size_t)>& texcoord_of) {
  TriangleMesh made;
  made.attributes.push_back({.components = 2, .values = {}});
  for (const Triangle& triangle : plain.triangles) {
    Triangle points{};
    for (size_t i = 0; i < 3; ++i) {
      points[i] = static_cast<uint32_t>(made.positions.size());
      made.positions.push_back(plain.positions[triangle[i]]);
      for (const double value : texcoord_of(triangle, i)) made.attributes[0].values.push_back(value);
    }
    made.triangles.push_back(points);
  }
  return build_mesh(made).triangles();
}

Texcoord texcoord_at(const TriangleMesh& mesh, uint32_t point) {
  return {mesh.attributes[0].values[2 * point], mesh.attributes[0].values[2 * point + 1]};
}

Texcoord sheet_texcoord(Vec3d p) { return {0.1 + 0.7 * p.x - 0.2 * p.y, 0.3 + 0.6 * p.y}; }

TriangleMesh flat_sheet(uint32_t n) {
  TriangleMesh sheet = test::grid(n, n);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> noise(-0.3F, 0.3F);
  const auto size = static_cast<float>(n);
  for (Vec3f& p : sheet.positions) {
    if (p.x > 0 && p.x < size && p.y > 0 && p.y < size) p = {p.x + noise(random), p.y + noise(random), 0};
    p = (1 / size) * p;
  }
  return with_texcoords(sheet, [&](const Triangle& t, size_t i) {
    const Vec3f p = sheet.positions[t[i]];
    return sheet_texcoord(to_double(p));
  });
}

TriangleMesh textured_tube(uint32_t n, uint32_t m) {
  const TriangleMesh made = tube(n, m, 2);
  return with_texcoords(made, [&](const Triangle& t, size_t i) {
    const auto column = [&](uint32_t v) { return v % n; };
    const bool is_last = std::ranges::any_of(t, [&](uint32_t v) { return column(v) == n - 1; });
    const double turn = is_last && column(t[i]) == 0 ? 1 : static_cast<double>(column(t[i])) / n;
    return Texcoord{turn, made.positions[t[i]].z / 2};
  });
}

Texcoord box_texcoord(Vec3d normal, Vec3d p) {
  const double side = normal.x + normal.y + normal.z > 0 ? 0.5 : 0;
  if (std::abs(normal.x) > std::abs(normal.y) + std::abs(normal.z)) return {0.3 * p.y, side + 0.3 * p.z};
  if (std::abs(normal.y) > std::abs(normal.z)) return {0.35 + 0.3 * p.x, side + 0.3 * p.z};
  return {0.7 + 0.3 * p.x, side + 0.3 * p.y};
}

TriangleMesh charted_box(uint32_t cells) {
  const TriangleMesh box = test::box({cells, cells, cells}, {1, 1, 1});
  return with_texcoords(box, [&](const Triangle& t, size_t i) {
    const auto place = [&](size_t corner) { return to_double(box.positions[t[corner]]); };
    return box_texcoord(cross(place(1) - place(0), place(2) - place(0)), place(i));
  });
}

}  // namespace papilio::test
