#include "server/samples/models.h"

#include <gtest/gtest.h>

#include "papilio/mesh.h"
#include "tests/support/invariants.h"

namespace papilio {
namespace {

double signed_volume(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (const Triangle& t : mesh.triangles)
    six_volumes +=
        dot(to_double(mesh.positions[t[0]]), cross(to_double(mesh.positions[t[1]]), to_double(mesh.positions[t[2]])));
  return six_volumes / 6;
}

struct Expected {
  uint32_t vertices, faces;
  int64_t euler_characteristic;
};

void expect_clean(const TriangleMesh& model, const Expected& expected) {
  BuildReport report;
  const Mesh mesh = build_mesh(model, &report);
  EXPECT_EQ(mesh.topology.vertex_count, expected.vertices);
  EXPECT_EQ(mesh.topology.face_count(), expected.faces);
  EXPECT_EQ(mesh.topology.euler_characteristic(), expected.euler_characteristic);
  EXPECT_EQ(report.welded_points + report.isolated_points, 0U);
  EXPECT_EQ(report.degenerate_faces + report.repeated_faces, 0U);
  EXPECT_EQ(report.boundary_edges + report.non_manifold_edges + report.misoriented_edges, 0U);
  EXPECT_EQ(report.pinched_vertices, 0U);
  EXPECT_TRUE(test::is_consistent(mesh));
}

TEST(Models, KnotIsAClosedTube) { expect_clean(server::knot(), {216, 432, 0}); }

TEST(Models, MugIsClosedWithThePapersCounts) { expect_clean(server::mug(), {172, 344, 0}); }

TEST(Models, WheelIsClosedWithThePapersCounts) { expect_clean(server::wheel(), {163, 290, 18}); }

TEST(Models, FacesLookOutward) {
  // Volumes of a mug of these dimensions, and of the wheel's parts (torus, hub, spokes) as coarse polygons.
  EXPECT_GT(signed_volume(server::knot()), 500);
  EXPECT_NEAR(signed_volume(server::mug()), 115, 15);
  EXPECT_NEAR(signed_volume(server::wheel()), 8300, 500);
}

}  // namespace
}  // namespace papilio
