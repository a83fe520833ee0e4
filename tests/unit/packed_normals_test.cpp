#include "proto/detail/packed_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proto/detail/decode_packed.h"
#include "proto/detail/packed_reader.h"
#include "proto/detail/plain_draco.h"
#include "proto/detail/plain_original.h"
#include "proto/draco_reader.h"
#include "proto/gltf/flattening.h"
#include "proto/problem.h"
#include "proto/refinement.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/lens.h"
#include "tests/support/packed_model.h"
#include "tests/support/shapes.h"

// Normals of packed models and of plain Draco files that replace them.

namespace papilio::proto::detail {
namespace {

using test::Shading;

FormattedMesh with_normal_format(const TriangleMesh& mesh) {
  FormattedMesh made;
  static_cast<TriangleMesh&>(made) = mesh;
  if (!mesh.attributes.empty()) append_normals(made.format);
  return made;
}

FormattedMesh small_lens(double degrees, Shading shading) {
  return with_normal_format(test::lens(12, 4, degrees, shading));
}

/// Writes an original without levels, as pack() does if that is smaller, and reads it.
PlainModel packed_plainly(const FormattedMesh& original) {
  const PlainOriginal plain = plain_original(build_mesh(original, nullptr, rounding_gap));
  const PlainDraco file =
      write_plain_draco(plain.mesh, 1e-5, {.normals = plain.has_normals ? NormalStyle::absent : plain.normals});
  const std::optional<PlainModel> read = read_plain_draco(file.glb, {});
  EXPECT_TRUE(read);
  EXPECT_EQ(plain.has_normals, read && !read->mesh.attributes.empty());
  return read.value_or(PlainModel{});
}

/// Returns the largest angle between the normals of a lens and of a mesh of it, in degrees.
double largest_angle(const FormattedMesh& mesh, double degrees) {
  double largest = 0;
  for (const Triangle& triangle : mesh.triangles) {
    float height = 0;
    for (const uint32_t p : triangle) height += mesh.positions[p].z;
    for (const uint32_t p : triangle) {
      const double* value = &mesh.attributes.at(0).values[size_t{3} * p];
      const Vec3d expected = test::lens_normal(mesh.positions[p], degrees, height > 0);
      const Vec3d normal{value[0], value[1], value[2]};
      largest = std::max(largest, std::atan2(length(cross(normal, expected)), dot(normal, expected)));
    }
  }
  return largest * 180 / std::numbers::pi;
}

TEST(PackedNormals, StyleRoundTrips) {
  test::PackedFixture made = test::packed_fixture(test::cube(), 1);
  EXPECT_EQ(read_packed(made.glb).normals, NormalStyle::absent);
  for (const NormalStyle style : {NormalStyle::smooth, NormalStyle::creased, NormalStyle::faceted}) {
    made.detail.normals = style;
    EXPECT_EQ(read_packed(write_packed(made.detail, {made.base_stream})).normals, style);
  }
}

TEST(PackedNormals, UnknownStyleIsRefused) {
  test::PackedFixture made = test::packed_fixture(test::cube(), 1);
  made.detail.normals = NormalStyle::smooth;
  const std::string glb = write_packed(made.detail, {made.base_stream});
  const std::string known = R"("normals":"smooth")";
  for (const std::string_view other : {R"("normals":"smOoth")", R"("normals": 1234567)", R"("normals":["othe"])"}) {
    std::string changed = glb;
    ASSERT_EQ(other.size(), known.size());
    changed.replace(changed.find(known), known.size(), other);
    try {
      (void)read_packed(changed);
      ADD_FAILURE() << other;
    } catch (const Problem& problem) {
      EXPECT_EQ(problem.code(), Code::mesh_not_gltf);
    }
  }
}

TEST(PackedNormals, StyleOfTheOriginalIsTheDefault) {
  PackedModel model = read_packed(test::packed_fixture(test::cube(), 1).glb);
  EXPECT_TRUE(decode_packed(model).attributes.empty());
  EXPECT_EQ(decode_packed(model, {.normals = NormalStyle::smooth}).attributes.size(), 1U);
  model.normals = NormalStyle::faceted;
  EXPECT_TRUE(decode_packed(model).attributes.empty());
  model.normals = NormalStyle::smooth;
  EXPECT_TRUE(decode_packed(model, {.normals = NormalStyle::absent}).attributes.empty());
  const FormattedMesh smooth = decode_packed(model);
  EXPECT_EQ(smooth.positions.size(), 26U) << "one normal per vertex";
  EXPECT_EQ(smooth.format.attributes.at(0).kind, AttributeKind::normal);
  for (size_t i = 0; i < smooth.attributes.at(0).values.size(); i += 3) {
    const double* n = &smooth.attributes[0].values[i];
    EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-6);
  }
}

TEST(PackedNormals, RefinementsHaveTheDecodersNormals) {
  test::PackedFixture made = test::packed_fixture(test::cube(), 1);
  for (const NormalStyle style :
       {NormalStyle::absent, NormalStyle::smooth, NormalStyle::creased, NormalStyle::faceted}) {
    made.detail.normals = style;
    const std::string glb = write_packed(made.detail, {made.base_stream});
    const Parameters parameters = parse_query({{"levels", "1"}, {"output.compress", "same"}});
    const FormattedMesh mesh = read_draco(Refinement(glb, parameters, {}).run().bytes, {});
    EXPECT_EQ(mesh.attributes.size(), has_detail_normals(style) ? 1U : 0U);
    const FormattedMesh scene =
        gltf::flatten_scene(test::refined(glb, {{"levels", "1"}, {"output.compress", "none"}}).bytes, {});
    ASSERT_EQ(scene.attributes.size(), has_detail_normals(style) ? 1U : 0U);
    if (scene.attributes.empty()) continue;
    const FormattedMesh unpacked = decode_packed(read_packed(glb));
    ASSERT_EQ(scene.positions.size(), unpacked.positions.size());
    for (size_t p = 0; p < scene.positions.size(); ++p) {
      const auto same = std::ranges::find(unpacked.positions, scene.positions[p]);
      ASSERT_NE(same, unpacked.positions.end());
      const auto other = static_cast<size_t>(same - unpacked.positions.begin());
      for (size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(scene.attributes[0].values[3 * p + i], unpacked.attributes[0].values[3 * other + i], 1e-6);
    }
  }
}

TEST(PlainNormals, NormalsAreStoredIfHardEdgesAreNotSharp) {
  const PlainModel model = packed_plainly(small_lens(20, Shading::hard_rim));
  EXPECT_EQ(model.normals, NormalStyle::absent);
  ASSERT_EQ(model.mesh.attributes.size(), 1U);
  EXPECT_LT(largest_angle(model.mesh, 20), 2);
}

TEST(PlainNormals, NormalsAreRecomputedIfHardEdgesAreSharp) {
  const PlainModel model = packed_plainly(small_lens(90, Shading::hard_rim));
  EXPECT_EQ(model.normals, NormalStyle::creased);
  EXPECT_TRUE(model.mesh.attributes.empty());
  const FormattedMesh shaded = with_normals(model.mesh, model.normals);
  EXPECT_EQ(shaded.positions.size(), model.mesh.positions.size() + 12) << "the rim is split";
  EXPECT_LT(largest_angle(shaded, 90), 10);
}

TEST(PlainNormals, SmoothAndFacetedNormalsAreRecomputed) {
  const PlainModel smooth = packed_plainly(small_lens(90, Shading::smooth));
  EXPECT_EQ(smooth.normals, NormalStyle::smooth);
  EXPECT_TRUE(smooth.mesh.attributes.empty());
  EXPECT_EQ(with_normals(smooth.mesh, smooth.normals).positions.size(), smooth.mesh.positions.size());
  const PlainModel faceted = packed_plainly(small_lens(90, Shading::faceted));
  EXPECT_EQ(faceted.normals, NormalStyle::faceted);
  EXPECT_TRUE(with_normals(faceted.mesh, faceted.normals).attributes.empty());
}

TEST(PlainNormals, MissingNormalsAreComputedFromTheShape) {
  const PlainModel prism = packed_plainly(with_normal_format(test::tube(10, 1, 2, true)));
  EXPECT_EQ(prism.normals, NormalStyle::absent);
  const FormattedMesh shaded = with_normals_of_shape(prism.mesh);
  ASSERT_EQ(shaded.attributes.size(), 1U);
  for (const Triangle& triangle : shaded.triangles) {  // its sides meet at 36 degrees, below the angle of sharp curves
    const auto at = [&](size_t i) { return to_double(shaded.positions[triangle[i]]); };
    const Vec3d normal = cross(at(1) - at(0), at(2) - at(0));
    for (const uint32_t p : triangle) {
      const double* value = &shaded.attributes[0].values[size_t{3} * p];
      EXPECT_GT(dot(normal, Vec3d{value[0], value[1], value[2]}), 0.9999 * length(normal));
    }
  }
  const PlainModel ring = packed_plainly(with_normal_format(test::torus(32, 20)));
  EXPECT_EQ(with_normals_of_shape(ring.mesh).positions.size(), ring.mesh.positions.size()) << "nothing is split";
}

TEST(PlainNormals, InvertedNormalsAreStoredButNotCompared) {
  TriangleMesh turned = test::lens(12, 4, 90, Shading::smooth);
  for (double& value : turned.attributes[0].values) value = -value;
  const PlainOriginal made = plain_original(build_mesh(turned));
  EXPECT_TRUE(made.has_normals);
  ASSERT_TRUE(made.compared);
  EXPECT_TRUE(made.compared->attributes.empty());
}

}  // namespace
}  // namespace papilio::proto::detail
