#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilio/refine.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "tests/support/invariants.h"

// Non-orientable surfaces: along a line of edges both faces run in the same direction. Each side is refined as at a
// boundary, without a crack.

namespace papilio {
namespace {

using namespace test;

constexpr uint32_t around = 16, across = 6;

/// Grid of quads; i = `around` is i = 0 with j reversed. `columns`: vertices across.
template <class At>
TriangleMesh turned_strip(uint32_t columns, uint32_t cells, const At& at) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < columns; ++j)
      mesh.positions.push_back(to_float(at(2 * std::numbers::pi * i / around, static_cast<double>(j))));
  const auto vertex = [&](uint32_t i, uint32_t j) {
    j %= columns;
    if (i < around) return i * columns + j;
    return cells == columns ? (columns - j) % columns : columns - 1 - j;
  };
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < cells; ++j) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  return mesh;
}

TriangleMesh moebius_strip() {
  return turned_strip(across + 1, across, [](double u, double j) {
    const double s = 0.8 * (j / across - 0.5);
    const double radius = 1 + s * std::cos(u / 2);
    return Vec3d{radius * std::cos(u), radius * std::sin(u), s * std::sin(u / 2)};
  });
}

/// A figure of eight swept round with half a turn; the vertices at its self-intersection stay separate.
TriangleMesh klein_bottle() {
  return turned_strip(across, across, [](double u, double j) {
    const double v = 2 * std::numbers::pi * j / across;
    const double a = std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
    const double b =
        std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v) + 0.2 * std::cos(v) * (1.5 + std::sin(u));
    return Vec3d{(2 + a) * std::cos(u), (2 + a) * std::sin(u), b};
  });
}

std::vector<Options> requests() {
  std::vector<Options> all;
  for (const Scheme scheme : {Scheme::red_green, Scheme::in_place})
    for (const Tension tension : {Tension::soft, Tension::off, Tension::sharp}) {
      const Options plain{.levels = 3, .scheme = scheme, .tension = tension};
      Options by_tolerance = plain;
      by_tolerance.tolerance = 0.002;
      Options by_flatness = plain;
      by_flatness.flatness = {0.8, 0.9};
      Options by_budget = plain;
      by_budget.max_faces = 1500;
      Options seen = plain;
      seen.view = View{.eye = {0, 1, 6}, .edge_pixels = 4};
      all.insert(all.end(), {plain, by_tolerance, by_flatness, by_budget, seen});
    }
  return all;
}

TEST(NonOrientable, MoebiusStripHasOneBoundaryAndNoCrack) {
  const TriangleMesh strip = moebius_strip();
  ASSERT_EQ(count_edges(strip).boundary, 2 * around);
  BuildReport found;
  const Mesh coarse = build_mesh(strip, &found);
  EXPECT_EQ(found.misoriented_edges, across);
  for (const Options& options : requests()) {
    const Mesh fine = refine(coarse, options).mesh;
    EXPECT_TRUE(is_consistent(fine));
    EXPECT_EQ(euler_characteristic(fine.triangles()), 0);
    const EdgeCensus edges = count_edges(fine.triangles());
    // Edges with one face are the halves of boundary edges.
    EXPECT_LE(edges.boundary, 8 * 2 * around);
    EXPECT_GE(edges.boundary, 2 * around);
    EXPECT_GE(edges.irregular, across);
  }
  const EdgeCensus uniform = count_edges(refine(coarse, {.levels = 3}).mesh.triangles());
  EXPECT_EQ(uniform.boundary, 8 * 2 * around);
  EXPECT_EQ(uniform.irregular, 8 * across);
}

TEST(NonOrientable, KleinBottleStaysClosed) {
  const TriangleMesh bottle = klein_bottle();
  ASSERT_EQ(count_edges(bottle).boundary, 0U);
  BuildReport found;
  const Mesh coarse = build_mesh(bottle, &found);
  EXPECT_EQ(found.misoriented_edges, across);
  for (const Options& options : requests()) {
    const Mesh fine = refine(coarse, options).mesh;
    EXPECT_TRUE(is_consistent(fine));
    EXPECT_EQ(euler_characteristic(fine.triangles()), 0);
    EXPECT_EQ(count_edges(fine.triangles()).boundary, 0U);
  }
}

TEST(NonOrientable, DracoKeepsEveryFace) {
  for (const TriangleMesh& surface : {moebius_strip(), klein_bottle()})
    for (const int speed : {0, 3, 7}) {
      const Mesh fine = refine(build_mesh(surface), {.levels = 2}).mesh;
      const std::string bytes =
          proto::write_draco(fine, proto::quantization_box(fine.positions), {.position_bits = 16, .speed = speed});
      const Mesh back = build_mesh(proto::read_draco(bytes, {}));
      EXPECT_EQ(back.topology.face_count(), fine.topology.face_count());
      EXPECT_EQ(back.topology.vertex_count, fine.topology.vertex_count);
      EXPECT_EQ(count_edges(back.triangles()).boundary, count_edges(fine.triangles()).boundary);
    }
}

}  // namespace
}  // namespace papilio
