#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "client/lib/compare.h"
#include "papilio/error.h"
#include "proto/detail/base_coder.h"
#include "proto/detail/part_streams.h"
#include "proto/detail/plain_draco.h"
#include "proto/draco_reader.h"
#include "proto/gltf/flattening.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio::proto::detail {
namespace {

TEST(BaseCoder, CodedBaseEqualsItsDecodedStream) {
  DracoBaseCoder coder(1e-3);
  const CodedBase torus = coder.code(test::torus(9, 7));
  const CodedBase icosahedron = coder.code(test::icosahedron());
  for (const CodedBase* coded : {&torus, &icosahedron}) {
    const std::string& stream = coder.streams_of(coded->triangles).at(0);
    EXPECT_EQ(stream.size(), coded->bytes);
    EXPECT_EQ(static_cast<TriangleMesh>(read_draco(stream, {})), coded->triangles);
  }
  EXPECT_THROW((void)coder.streams_of(test::cube()), std::logic_error);
}

TEST(BaseCoder, VerticesMoveWithinTheBound) {
  const TriangleMesh base = test::torus(30, 20);
  for (const double most : {1e-2, 1e-3, 1e-4, 1e-5}) {
    DracoBaseCoder coder(most);
    const CodedBase coded = coder.code(base);
    const auto found = client::compare(base, coded.triangles, {.samples = 0});
    EXPECT_LE(found.hausdorff, most);
    EXPECT_EQ(coded.triangles.triangles.size(), base.triangles.size());
  }
}

TEST(BaseCoder, SmallerOfTwoStreamsIsTaken) {
  std::set<bool> is_slow_smaller;
  for (const TriangleMesh& base : {test::torus(60, 40), test::real_mesh("bunny600.obj")}) {
    DracoBaseCoder coder(1e-3);
    const CodedBase coded = coder.code(base);
    const std::string& taken = coder.streams_of(coded.triangles).at(0);
    const Mesh mesh = build_mesh(base);
    for (int bits = fewest_position_bits; bits <= most_position_bits; ++bits) {
      const auto at_speed = [&](int speed) {
        const QuantizationBox grid = tight_box(bounding_box(mesh.positions));
        return write_parts(mesh, grid, {.position_bits = bits, .speed = speed}).streams.at(0);
      };
      const std::string slow = at_speed(0), fast = at_speed(3);
      if (taken != slow && taken != fast) continue;
      EXPECT_EQ(coded.bytes, std::min(slow.size(), fast.size()));
      is_slow_smaller.insert(slow.size() < fast.size());
    }
  }
  EXPECT_EQ(is_slow_smaller.size(), 2U) << "one of the speeds is never smaller";
}

TEST(BaseCoder, VerticesWithNormalsSlideOntoACoarserGrid) {
  constexpr double most_move = 1e-4, most_slide = 8e-4;
  const TriangleMesh torus = test::torus(30, 20);
  const auto from_ring = [](Vec3d p) { return p - Vec3d{p.x / std::hypot(p.x, p.y), p.y / std::hypot(p.x, p.y), 0}; };
  std::vector<Vec3d> normals;
  for (const Vec3f& p : torus.positions) normals.push_back(1 / 0.4 * from_ring(to_double(p)));
  const CodedBase slid = DracoBaseCoder(most_move, most_slide).code(torus, normals);
  const CodedBase rounded = DracoBaseCoder(most_move).code(torus);
  EXPECT_LT(static_cast<double>(slid.bytes), 0.9 * static_cast<double>(rounded.bytes));
  const double largest = client::compare(torus, slid.triangles, {.samples = 0}).hausdorff;
  EXPECT_GT(largest, most_move);
  EXPECT_LE(largest, most_slide);
  for (const Vec3f& p : slid.triangles.positions)
    EXPECT_NEAR(length(from_ring(to_double(p))), 0.4, most_move + 2 * most_slide * most_slide);

  const auto move_of_7 = [&](const CodedBase& coded) {
    return length(to_double(coded.moved[7]) - to_double(torus.positions[7]));
  };
  EXPECT_GT(move_of_7(slid), most_move);
  normals[7] = {};
  EXPECT_LE(move_of_7(DracoBaseCoder(most_move, most_slide).code(torus, normals)), most_move);
}

TEST(BaseCoder, CloseVerticesStayDistinct) {
  TriangleMesh base = test::bipyramid(40);
  for (Vec3f& p : base.positions)
    if (p.z == 0) p = {1 + 1e-3F * p.x, 1e-3F * p.y, 0};  // a ring of edges of 1.6e-4 between distant apexes
  DracoBaseCoder coder(1);
  BuildReport found;
  (void)build_mesh(coder.code(base).triangles, &found);
  EXPECT_EQ(found.welded_points + found.degenerate_faces + found.boundary_edges, 0U);
}

// Two octahedra whose tips nearly touch, far less than their edges apart: on coarse grids to the same point.
TEST(BaseCoder, NearVerticesGetPointsOfTheirOwn) {
  const double most = 0.1;
  for (int i = 1; i <= 40; ++i) {
    const float gap = 0.0013F * static_cast<float>(i);
    const TriangleMesh base = test::join(test::octahedron(), test::octahedron(), 2 + gap);
    for (const bool slides : {false, true}) {
      DracoBaseCoder coder(most, most);
      const std::vector<Vec3d> normals(slides ? base.positions.size() : 0, Vec3d{0.36, 0.48, 0.8});
      const CodedBase coded = coder.code(base, normals);
      ASSERT_EQ(coded.moved.size(), base.positions.size());
      for (size_t v = 0; v < base.positions.size(); ++v) {
        const auto distance = [&](Vec3f p) { return length(to_double(p) - to_double(coded.moved[v])); };
        EXPECT_LE(distance(base.positions[v]), most) << gap << slides;
        const auto near = std::ranges::count_if(coded.triangles.positions, [&](Vec3f p) { return distance(p) < 1e-6; });
        EXPECT_EQ(near, 1) << gap << slides;
      }
    }
  }
}

TEST(BaseCoder, GridIsNoFinerForNearVertices) {
  const TriangleMesh apart = test::join(test::torus(12, 8), test::octahedron(), 4);
  TriangleMesh near = test::join(apart, test::octahedron(), 0);
  for (size_t v = apart.positions.size(); v < near.positions.size(); ++v)
    near.positions[v] = to_float(1e-4 * to_double(near.positions[v]) + Vec3d{5, 0, 0});
  DracoBaseCoder coder(0.05);
  EXPECT_LT(coder.code(near).bytes, coder.code(apart).bytes + 60);
}

// Draco cuts two faces back to back apart, and repeats their points.
TEST(BaseCoder, FacesBackToBackAreCoded) {
  TriangleMesh base = test::join(test::icosahedron(), test::octahedron(), 3);
  const auto first = static_cast<uint32_t>(base.positions.size());
  base.positions.insert(base.positions.end(), {{9, 0, 0}, {9, 1, 0}, {9, 0, 1}});
  base.triangles.push_back({first, first + 1, first + 2});
  base.triangles.push_back({first, first + 2, first + 1});
  const CodedBase coded = DracoBaseCoder(1e-3).code(base);
  EXPECT_EQ(coded.triangles.triangles.size(), base.triangles.size());
  const Mesh mesh = build_mesh(coded.triangles);
  EXPECT_EQ(mesh.topology.vertex_count, base.positions.size());
  EXPECT_EQ(mesh.topology.edge_count(), build_mesh(base).topology.edge_count());
}

TEST(BaseCoder, VerticesTooCloseForAnyGridAreRefused) {
  TriangleMesh base = test::octahedron();
  base.positions[0] = {1e9F, 0, 0};
  EXPECT_THROW((void)DracoBaseCoder(1).code(base), Error);
}

TEST(BaseCoder, TightGridExceedsTheBoxByAtMostAMillionth) {
  const Box box{{1, 2, 3}, {5, 4, 3.5F}};
  const QuantizationBox grid = tight_box(box);
  EXPECT_EQ(grid.origin.x, 1);
  EXPECT_GE(grid.range, 4);
  EXPECT_LE(grid.range, 4.000001F);
}

TEST(BaseCoder, StatedGridDistanceEqualsTheMeasured) {
  const Mesh mesh = build_mesh(test::torus(60, 40));
  for (const int bits : {8, 10, 12}) {
    const double expected = grid_rms(mesh, bits);
    const PlainDraco plain = write_plain_draco(mesh, expected);
    EXPECT_EQ(plain.position_bits, bits);
    const auto found = client::compare(mesh.triangles(), gltf::flatten_scene(plain.glb, {}));
    EXPECT_NEAR(found.rms / found.diagonal, expected, 0.1 * expected) << bits;
  }
}

TEST(BaseCoder, PlainDracoHasTheFewestBits) {
  const Mesh mesh = build_mesh(test::torus(60, 40));
  for (const double rms : {1e-3, 1e-4, 1e-5}) {
    const PlainDraco plain = write_plain_draco(mesh, rms);
    EXPECT_LE(plain.rms, rms);
    EXPECT_TRUE(plain.position_bits == fewest_position_bits || grid_rms(mesh, plain.position_bits - 1) > rms);
  }
}

}  // namespace
}  // namespace papilio::proto::detail
