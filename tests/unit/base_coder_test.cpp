#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

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
  constexpr double most = 1e-3;
  std::set<bool> is_slow_smaller;
  for (const TriangleMesh& base : {test::torus(60, 40), test::real_mesh("bunny600.obj")}) {
    const Mesh mesh = build_mesh(base);
    int bits = fewest_position_bits;
    while (tight_grid_distance(bounding_box(mesh.positions), bits) > most) ++bits;
    const uint64_t slow = write_parts(mesh, {.position_bits = bits, .speed = 0}).bytes();
    const uint64_t fast = write_parts(mesh, {.position_bits = bits, .speed = 3}).bytes();
    EXPECT_EQ(DracoBaseCoder(most).code(base).bytes, std::min(slow, fast));
    is_slow_smaller.insert(slow < fast);
  }
  EXPECT_EQ(is_slow_smaller.size(), 2U) << "one of the speeds is never smaller";
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
