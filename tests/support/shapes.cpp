#include "tests/support/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "papilio/mesh.h"

namespace papilio::test {
namespace {

constexpr double pi = std::numbers::pi;

float uniform(std::mt19937& random, double low, double high) {
  return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random));
}

uint32_t below(std::mt19937& random, uint32_t bound) {
  return std::uniform_int_distribution<uint32_t>(0, bound - 1)(random);
}

/// Splits random faces in three at their centre: valences of 3 and large valences.
void pierce(TriangleMesh& mesh, std::mt19937& random, uint32_t times) {
  for (uint32_t i = 0; i < times; ++i) {
    const uint32_t f = below(random, static_cast<uint32_t>(mesh.triangles.size()));
    const Triangle t = mesh.triangles[f];
    const auto centre = static_cast<uint32_t>(mesh.positions.size());
    const Vec3f sum = mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]];
    mesh.positions.push_back((1.0F / 3) * sum);
    mesh.triangles[f] = {t[0], t[1], centre};
    mesh.triangles.push_back({t[1], t[2], centre});
    mesh.triangles.push_back({t[2], t[0], centre});
  }
}

/// Removes faces of which no two share a vertex: each leaves a hole with a simple boundary.
void punch_holes(TriangleMesh& mesh, std::mt19937& random, uint32_t times) {
  std::vector<bool> taken(mesh.positions.size());
  for (uint32_t i = 0; i < times && mesh.triangles.size() > 4; ++i) {
    const uint32_t f = below(random, static_cast<uint32_t>(mesh.triangles.size()));
    const Triangle t = mesh.triangles[f];
    if (taken[t[0]] || taken[t[1]] || taken[t[2]]) continue;
    for (uint32_t v : t) taken[v] = true;
    std::copy(mesh.triangles.begin() + f + 1, mesh.triangles.end(), mesh.triangles.begin() + f);
    mesh.triangles.pop_back();
  }
}

}  // namespace

TriangleMesh tetrahedron() {
  return {{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TriangleMesh octahedron() { return bipyramid(4); }

TriangleMesh icosahedron() {
  const auto g = static_cast<float>(std::numbers::phi);
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}},
          {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
           {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
           {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

TriangleMesh cube() {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 8; ++i)
    mesh.positions.push_back({(i & 1U) != 0 ? 1.0F : 0.0F, (i & 2U) != 0 ? 1.0F : 0.0F, (i & 4U) != 0 ? 1.0F : 0.0F});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh box(std::array<uint32_t, 3> cells, Vec3f size) {
  using Corner = std::array<uint32_t, 3>;
  TriangleMesh mesh;
  std::map<Corner, uint32_t> known;
  const auto vertex = [&](Corner c) {
    const auto [it, is_new] = known.try_emplace(c, static_cast<uint32_t>(mesh.positions.size()));
    const auto along = [&](uint32_t axis, float whole) {
      return whole * static_cast<float>(c[axis]) / static_cast<float>(cells[axis]);
    };
    if (is_new) mesh.positions.push_back({along(0, size.x), along(1, size.y), along(2, size.z)});
    return it->second;
  };
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t u = (axis + 1) % 3;
    const uint32_t v = (axis + 2) % 3;
    for (uint32_t i = 0; i < cells[u]; ++i)
      for (uint32_t j = 0; j < cells[v]; ++j)
        for (const bool far : {false, true}) {
          Corner corner{};
          corner[axis] = far ? cells[axis] : 0;
          const auto at = [&](uint32_t du, uint32_t dv) {
            Corner c = corner;
            c[u] = i + du;
            c[v] = j + dv;
            return vertex(c);
          };
          const uint32_t a = at(0, 0);
          const uint32_t b = far ? at(1, 0) : at(0, 1);
          const uint32_t d = far ? at(0, 1) : at(1, 0);
          mesh.triangles.push_back({a, b, at(1, 1)});
          mesh.triangles.push_back({a, at(1, 1), d});
        }
  }
  return mesh;
}

TriangleMesh square_ring(uint32_t n, float inner, float outer, float height) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < n; ++i) {
    const auto c = static_cast<float>(std::cos(2 * pi * i / n));
    const auto s = static_cast<float>(std::sin(2 * pi * i / n));
    for (const auto& [radius, z] : {std::pair{inner, 0.0F}, {outer, 0.0F}, {outer, height}, {inner, height}})
      mesh.positions.push_back({radius * c, radius * s, z});
  }
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t j = (i + 1) % n;
    for (uint32_t k = 0; k < 4; ++k) {
      const uint32_t l = (k + 1) % 4;
      mesh.triangles.push_back({4 * i + k, 4 * j + l, 4 * j + k});
      mesh.triangles.push_back({4 * i + k, 4 * i + l, 4 * j + l});
    }
  }
  return mesh;
}

TriangleMesh tube(uint32_t n, uint32_t m, float height, bool has_lids) {
  TriangleMesh made;
  for (uint32_t j = 0; j <= m; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * pi * i / n;
      made.positions.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                                height * static_cast<float>(j) / static_cast<float>(m)});
    }
  for (uint32_t j = 0; j < m; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = j * n + i;
      const uint32_t b = j * n + (i + 1) % n;
      made.triangles.push_back({a, b, b + n});
      made.triangles.push_back({a, b + n, a + n});
    }
  if (!has_lids) return made;
  for (const bool is_top : {false, true}) {
    const auto centre = static_cast<uint32_t>(made.positions.size());
    made.positions.push_back({0, 0, is_top ? height : 0});
    const uint32_t first = is_top ? m * n : 0;
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = first + i;
      const uint32_t b = first + (i + 1) % n;
      made.triangles.push_back(is_top ? Triangle{a, b, centre} : Triangle{b, a, centre});
    }
  }
  return made;
}

TriangleMesh torus(uint32_t n, uint32_t m, float radius, float tube_radius) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j < m; ++j) {
      const double u = 2 * pi * i / n;
      const double v = 2 * pi * j / m;
      const double r = radius + tube_radius * std::cos(v);
      mesh.positions.push_back(to_float({r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v)}));
      const auto at = [&](uint32_t a, uint32_t b) { return (i + a) % n * m + (j + b) % m; };
      mesh.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
      mesh.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  }
  return mesh;
}

TriangleMesh grid(uint32_t n, uint32_t m) {
  TriangleMesh mesh;
  for (uint32_t j = 0; j <= m; ++j)
    for (uint32_t i = 0; i <= n; ++i) mesh.positions.push_back({static_cast<float>(i), static_cast<float>(j), 0});
  for (uint32_t j = 0; j < m; ++j) {
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = j * (n + 1) + i;
      mesh.triangles.push_back({a, a + 1, a + n + 2});
      mesh.triangles.push_back({a, a + n + 2, a + n + 1});
    }
  }
  return mesh;
}

TriangleMesh fan(uint32_t triangles, bool closed, double sweep) {
  TriangleMesh mesh;
  mesh.positions.push_back({0, 0, 0});
  const uint32_t points = closed ? triangles : triangles + 1;
  for (uint32_t j = 0; j < points; ++j) {
    const double angle = (closed ? 2 * pi : sweep) * j / triangles;
    mesh.positions.push_back(to_float({std::cos(angle), std::sin(angle), 0}));
  }
  for (uint32_t j = 0; j < triangles; ++j) mesh.triangles.push_back({0, 1 + j, 1 + (j + 1) % points});
  return mesh;
}

TriangleMesh bipyramid(uint32_t ring) {
  TriangleMesh mesh;
  for (uint32_t j = 0; j < ring; ++j)
    mesh.positions.push_back(to_float({std::cos(2 * pi * j / ring), std::sin(2 * pi * j / ring), 0}));
  mesh.positions.push_back({0, 0, 1});
  mesh.positions.push_back({0, 0, -1});
  for (uint32_t j = 0; j < ring; ++j) {
    mesh.triangles.push_back({j, (j + 1) % ring, ring});
    mesh.triangles.push_back({(j + 1) % ring, j, ring + 1});
  }
  return mesh;
}

TriangleMesh join(const TriangleMesh& a, const TriangleMesh& b, float dx) {
  TriangleMesh both = a;
  const auto offset = static_cast<uint32_t>(a.positions.size());
  for (Vec3f p : b.positions) both.positions.push_back(p + Vec3f{dx, 0, 0});
  for (Triangle t : b.triangles) both.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return both;
}

TriangleMesh random_manifold(std::mt19937& random) {
  TriangleMesh mesh;
  const uint32_t components = 1 + below(random, 3);
  for (uint32_t c = 0; c < components; ++c) {
    TriangleMesh part;
    switch (below(random, 6)) {
      case 0:
        part = icosahedron();
        break;
      case 1:
        part = torus(3 + below(random, 5), 3 + below(random, 5));
        break;
      case 2:
        part = grid(1 + below(random, 5), 1 + below(random, 5));
        break;
      case 3:
        part = bipyramid(3 + below(random, 60));
        break;
      case 4:
        part = fan(1 + below(random, 9), false);
        break;
      default:
        part = tetrahedron();
    }
    pierce(part, random, below(random, 6));
    if (below(random, 2) == 0) punch_holes(part, random, 1 + below(random, 4));
    mesh = join(mesh, part, 10.0F * static_cast<float>(c));
  }
  for (Vec3f& p : mesh.positions)
    p += Vec3f{uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1)};
  std::ranges::shuffle(mesh.triangles, random);
  for (Triangle& t : mesh.triangles) std::rotate(t.begin(), t.begin() + below(random, 3), t.end());
  return mesh;
}

}  // namespace papilio::test
