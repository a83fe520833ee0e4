#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "papilio/mesh.h"

// Meshes of closed form. All are wound counter-clockwise seen from outside.

namespace papilio::test {

[[nodiscard]] TriangleMesh tetrahedron();
[[nodiscard]] TriangleMesh octahedron();
[[nodiscard]] TriangleMesh icosahedron();
[[nodiscard]] TriangleMesh cube();
/// A box from the origin to `size`, its sides cut into cells of two triangles each.
[[nodiscard]] TriangleMesh box(std::array<uint32_t, 3> cells, Vec3f size);
/// A ring of square section about the z axis, with n corners: radii from inner to outer, z from 0 to height.
[[nodiscard]] TriangleMesh square_ring(uint32_t n, float inner, float outer, float height);
/// A cylinder of radius 1 about the z axis from 0 to `height`, of n by m cells, optionally closed by flat lids.
[[nodiscard]] TriangleMesh tube(uint32_t n, uint32_t m, float height, bool has_lids = false);
/// n by m quadrangles in two triangles each: every vertex has valence 6.
[[nodiscard]] TriangleMesh torus(uint32_t n, uint32_t m, float radius = 1, float tube_radius = 0.4F);
/// The rectangle 0..n by 0..m in the plane z = 0, with two triangles per cell.
[[nodiscard]] TriangleMesh grid(uint32_t n, uint32_t m);
/// A fan of K triangles about the origin with its ring at radius 1. If not `closed`, the K triangles lie between two
/// boundary edges that span `sweep` radians.
[[nodiscard]] TriangleMesh fan(uint32_t triangles, bool closed, double sweep = 3.14159265358979);
/// A double cone: two apexes over a ring of K points.
[[nodiscard]] TriangleMesh bipyramid(uint32_t ring);
/// Returns both meshes as one, with the second moved by (dx, 0, 0).
[[nodiscard]] TriangleMesh join(const TriangleMesh& a, const TriangleMesh& b, float dx);

/// A random manifold: closed or open, of one component or several, of genus 0 or 1, with jittered positions and
/// valences from 3 up.
[[nodiscard]] TriangleMesh random_manifold(std::mt19937& random);

}  // namespace papilio::test
