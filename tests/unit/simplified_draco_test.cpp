#include "proto/detail/simplified_draco.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "papilio/error.h"
#include "papilio/refine.h"
#include "proto/detail/pack.h"
#include "proto/gltf/flattening.h"
#include "tests/support/bumpy_sphere.h"
#include "tests/support/detail_baseline.h"
#include "tests/support/rate_curve.h"
#include "tests/support/real_mesh.h"
#include "tests/support/sampled_distance.h"
#include "tests/support/shapes.h"

// Simplified meshes as Draco, the upper bound for the size of packed models.

namespace papilio::proto::detail {
namespace {

TriangleMesh sphere(int levels) {
  Options options;
  options.levels = levels;
  options.tension = Tension::off;
  TriangleMesh mesh = refine(build_mesh(test::icosahedron()), options).mesh.triangles();
  for (Vec3f& p : mesh.positions) p = (1 / length(p)) * p;
  return mesh;
}

/// A box with one protruding vertex in its upper side.
TriangleMesh spiked_box(uint32_t n) {
  TriangleMesh spiked = test::box({n, n, n}, {1, 1, 1});
  const auto tip = std::ranges::min_element(spiked.positions, {}, [](Vec3f p) {
    return length(p - Vec3f{0.5F, 0.5F, 1});
  });
  tip->z += 0.1F;
  return spiked;
}

TEST(SimplifiedDraco, FinelyDividedBoxHasTwelveFaces) {
  const auto made = write_simplified_draco(test::box({20, 20, 20}, {1, 2, 3}), {.rms = 1e-4});
  ASSERT_TRUE(made);
  EXPECT_EQ(made->faces, 12U);
  EXPECT_LE(made->reach.rms, 1e-4);
  EXPECT_EQ(made->bytes, made->glb.size());
}

TEST(SimplifiedDraco, StatedDistanceEqualsTheMeasured) {
  const TriangleMesh original = sphere(4);
  for (const double rms : {3e-3, 3e-4}) {
    const auto made = write_simplified_draco(original, {.rms = rms});
    ASSERT_TRUE(made);
    EXPECT_LE(made->reach.rms, rms);
    EXPECT_LT(made->faces, original.triangles.size());
    const auto read = read_plain_draco(made->glb, {});
    ASSERT_TRUE(read);
    EXPECT_EQ(read->mesh.triangles.size(), made->faces);
    const test::SampledDistance distance = test::SampledSurface(original, 40'000).distance_to(read->mesh);
    EXPECT_NEAR(distance.rms / 100, made->reach.rms, 0.05 * made->reach.rms);
  }
}

TEST(SimplifiedDraco, StreamIsSmallerThanThatOfTheBestBaseline) {
  constexpr double container = 600;  // lower bound: the document and the headers of its chunks
  const TriangleMesh original = test::bumpy_sphere(4);
  const test::DetailSubject subject("bumpy sphere", original, 40'000);
  const double rms = 3e-4;
  const auto best =
      test::at_rms(test::lower_envelope(test::quadrics_and_draco(subject, Quadrics::memoryless)), 100 * rms);
  const auto made = write_simplified_draco(original, {.rms = rms});
  ASSERT_TRUE(made && best);
  EXPECT_LT(static_cast<double>(made->bytes) - container, 0.9 * best->bytes);
}

TEST(SimplifiedDraco, CancellationStopsSimplification) {
  try {
    (void)write_simplified_draco(sphere(4), {.rms = 1e-3, .cancelled = [] { return true; }});
    ADD_FAILURE() << "it was not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::cancelled);
  }
}

TEST(Pack, SmallerSimplifiedMeshIsTheResult) {
  const Packed box = pack(test::box({21, 21, 21}, {1, 2, 3}), {.rms = 1e-3, .simplifies = true});
  EXPECT_FALSE(box.model);
  ASSERT_TRUE(box.simplified);
  EXPECT_EQ(box.simplified->bytes, box.glb.size());
  EXPECT_NE(box.reason.find("simplified mesh of 12 faces"), std::string::npos) << box.reason;
  EXPECT_LT(box.glb.size(), box.plain_bytes);
  const Packed round = pack(sphere(4), {.rms = 3e-4, .simplifies = true});
  ASSERT_TRUE(round.model);
  ASSERT_TRUE(round.simplified);
  EXPECT_LT(round.glb.size(), round.simplified->bytes);
}

TEST(SimplifiedDraco, LargestDistanceIsWithinItsBound) {
  const TriangleMesh spiked = spiked_box(4);
  const auto lost = write_simplified_draco(spiked, {.rms = 4e-3});
  const auto kept = write_simplified_draco(spiked, {.rms = 4e-3, .largest = 2e-2});
  ASSERT_TRUE(lost && kept);
  EXPECT_GT(lost->reach.largest, 3e-2);
  EXPECT_LE(kept->reach.largest, 2e-2);
  EXPECT_LE(kept->reach.rms, 4e-3);
  EXPECT_LT(lost->faces, kept->faces);
  EXPECT_THROW((void)write_simplified_draco(spiked, {.largest = 0}), Error);
}

TEST(Pack, SimplifiedMeshKeepsTheLargestDistance) {
  const TriangleMesh spiked = spiked_box(21);
  const double rms = 2e-3;
  EXPECT_GT(write_simplified_draco(spiked, {.rms = rms})->reach.largest, 16 * rms);
  const Packed packed = pack(spiked, {.rms = rms, .simplifies = true});
  ASSERT_TRUE(packed.simplified);
  EXPECT_EQ(packed.glb.size(), packed.simplified->bytes);
  EXPECT_LE(packed.simplified->reach.largest, 16 * rms);
}

TEST(Pack, ModelWithTurnedFacesIsRefused) {
  const TriangleMesh original = test::real_mesh("cgal/couplingdown.off");  // thin walls
  const Packed packed = pack(original, {.rms = 3e-3});
  EXPECT_FALSE(packed.model);
  EXPECT_THAT(packed.reason, ::testing::HasSubstr("would be turned over"));
  EXPECT_EQ(gltf::flatten_scene(packed.glb, {}).triangles.size(), original.triangles.size());
}

TEST(Pack, MeshOfFewFacesIsNotSimplified) {
  const TriangleMesh box = test::box({20, 20, 20}, {1, 2, 3});
  const Packed packed = pack(box, {.rms = 1e-2, .simplifies = true});
  EXPECT_FALSE(packed.simplified);
  EXPECT_LT(write_simplified_draco(box, {.rms = 1e-2})->bytes, packed.glb.size());
}

TEST(PackJobs, FileDoesNotDependOnTheJobs) {
  const TriangleMesh original = sphere(1);
  const Packed alone = pack(original, {.largest = 0.1});
  EXPECT_GT(alone.encodings, 1U);
  EXPECT_EQ(pack(original, {.largest = 0.1, .jobs = 4}).glb, alone.glb);
}

}  // namespace
}  // namespace papilio::proto::detail
