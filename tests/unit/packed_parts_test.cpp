#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "proto/detail/decode_packed.h"
#include "proto/detail/find_packed.h"
#include "proto/detail/mesh_parts.h"
#include "proto/detail/pack.h"
#include "proto/detail/packed_reader.h"
#include "proto/detail/plain_draco.h"
#include "proto/draco_reader.h"
#include "proto/gltf/container.h"
#include "proto/gltf/flattening.h"
#include "proto/gltf/material_attribute.h"
#include "proto/problem.h"
#include "proto/refinement.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/packed_model.h"
#include "tests/support/parted_torus.h"
#include "tests/support/shapes.h"

// Packed models of several materials: parts.

namespace papilio::proto::detail {
namespace {

using test::refusal_of;
using PartJson = test::GltfScene::Json;

/// A torus without a material in its first quarter and with two materials in the others. `has_texcoords`: shares of a
/// turn, cut at the start of the first part.
gltf::MaterialMesh parted_torus(bool has_texcoords = false) {
  gltf::MaterialMesh torus;
  static_cast<TriangleMesh&>(torus.mesh) = test::torus(96, 48);
  torus.materials.images.push_back({.name = "bark", .media_type = "image/png", .bytes = "the image's bytes"});
  torus.materials.materials = {{.name = "unused"}, {.name = "red", .roughness = 0.25}, {.name = "blue"}};
  if (has_texcoords) torus.materials.materials[2].image(gltf::ImageUse::base_color) = 0;
  for (const uint32_t part : test::parts_of_torus(torus.mesh))
    torus.materials.of_triangle.push_back(part == 0 ? none : part);
  if (!has_texcoords) return torus;
  TriangleMesh apart;  // a point for each corner
  Attribute texcoords{.components = 2, .values = {}};
  for (size_t t = 0; t < torus.mesh.triangles.size(); ++t) {
    const auto first = static_cast<uint32_t>(apart.positions.size());
    const Triangle& of = torus.mesh.triangles[t];
    const bool is_last = torus.materials.of_triangle[t] == 2;
    for (const uint32_t point : of) {
      const Vec3f at = torus.mesh.positions[point];
      const double turn = test::turn_of(to_double(at));
      texcoords.values.insert(texcoords.values.end(), {is_last && turn < 0.25 ? turn + 1 : turn, 0.5 + 0.5 * at.z});
      apart.positions.push_back(at);
    }
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  apart.attributes.push_back(std::move(texcoords));
  static_cast<TriangleMesh&>(torus.mesh) = std::move(apart);
  torus.mesh.format.attributes.push_back({.kind = AttributeKind::tex_coord, .id = 1});
  return torus;
}

constexpr double wanted = 1e-3;

std::string packed_torus(bool has_texcoords = false) {
  Packed packed = pack(parted_torus(has_texcoords), {.rms = wanted, .face_limit = 20'000});
  EXPECT_TRUE(packed.model) << packed.reason;
  return std::move(packed.glb);
}

Vec3d centre(const TriangleMesh& mesh, const Triangle& t) {
  return 1 / 3.0 *
         (to_double(mesh.positions[t[0]]) + to_double(mesh.positions[t[1]]) + to_double(mesh.positions[t[2]]));
}

/// Returns the number of faces whose material, by name, differs from that of the torus at their position.
size_t wrong_faces(const TriangleMesh& mesh, const gltf::Materials& materials) {
  const std::array<std::string, 3> names{"", "red", "blue"};
  size_t wrong = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const uint32_t number = materials.of_triangle.at(t);
    const std::string name = number == none ? "" : materials.materials.at(number).name;
    if (name != names.at(test::part_of_torus(centre(mesh, mesh.triangles[t])))) ++wrong;
  }
  return wrong;
}

/// Returns the largest distance of the ends of edges between two materials to an exact border.
double largest_miss_of_borders(const TriangleMesh& mesh, const std::vector<uint32_t>& of_triangle) {
  const Mesh built = build_mesh(TriangleMesh{mesh.positions, mesh.triangles});
  const Topology& t = built.topology;
  double largest = 0;
  size_t borders = 0;
  for (uint32_t e = 0; e < t.edge_count(); ++e) {
    const uint32_t h = t.half_edge[e];
    if (of_triangle.at(h / 3) == of_triangle.at(t.twin[h] / 3)) continue;
    ++borders;
    for (const uint32_t v : {t.origin[h], t.tip(h)})
      largest = std::max(largest, test::distance_to_border(to_double(built.positions[v])));
  }
  EXPECT_GE(borders, 3 * 8U);
  return largest;
}

/// Returns the materials of the faces of a level from those of the base.
std::vector<uint32_t> materials_below(const std::vector<uint32_t>& of_base, size_t faces) {
  std::vector<uint32_t> made;
  for (size_t f = 0; f < faces; ++f) made.push_back(of_base.at(f / (faces / of_base.size())));
  return made;
}

TEST(MeshParts, SplitPartsJoinToTheMesh) {
  const gltf::MaterialMesh torus = parted_torus(true);
  gltf::MaterialMesh numbered = torus;
  gltf::add_material_attribute(numbered);
  const std::vector<MeshPart> parts = split_parts(numbered.mesh);
  ASSERT_EQ(parts.size(), 3U);
  std::vector<double> numbers;
  size_t faces = 0;
  for (const MeshPart& part : parts) {
    numbers.push_back(part.number);
    faces += part.triangles.triangles.size();
    EXPECT_EQ(part.triangles.attributes.size(), 1U);
    EXPECT_FALSE(has_parts(part.triangles.attributes));
  }
  EXPECT_EQ(numbers, (std::vector<double>{0, 2, 3}));
  EXPECT_EQ(faces, torus.mesh.triangles.size());
  const TriangleMesh joined = join_parts(parts);
  EXPECT_TRUE(has_parts(joined.attributes));
  const std::vector<MeshPart> again = split_parts(joined);
  for (size_t p = 0; p < 3; ++p) EXPECT_EQ(again.at(p).triangles, parts[p].triangles);
}

TEST(MeshParts, MeshWithoutPartsIsOnePart) {
  const TriangleMesh cube = test::cube();
  EXPECT_FALSE(has_parts(cube.attributes));
  ASSERT_EQ(split_parts(cube).size(), 1U);
  EXPECT_EQ(split_parts(cube)[0].triangles, cube);
  EXPECT_EQ(join_parts(split_parts(cube)), cube);
}

TEST(PackedParts, DecodedPartsKeepMaterialsAndBorders) {
  for (const bool has_texcoords : {false, true}) {
    const std::string glb = packed_torus(has_texcoords);
    const gltf::MaterialMesh base = gltf::flatten_with_materials(glb, {});
    ASSERT_EQ(base.materials.materials.size(), 2U);
    EXPECT_EQ(base.materials.materials[0], (gltf::Material{.name = "red", .roughness = 0.25}));
    EXPECT_EQ(base.materials.images.size(), has_texcoords ? 1U : 0U);
    const PackedModel model = read_packed(glb);
    EXPECT_EQ(model.has_texcoords(), has_texcoords);
    EXPECT_LE(reach_of(model).rms, wanted);
    const FormattedMesh fine = decode_packed(model);
    gltf::Materials materials = base.materials;
    materials.of_triangle = materials_below(base.materials.of_triangle, fine.triangles.size());
    EXPECT_LE(wrong_faces(fine, materials), fine.triangles.size() / 200);
    const double diagonal = bounding_box(fine.positions).diagonal();
    EXPECT_LT(largest_miss_of_borders(fine, materials.of_triangle), 7 * wanted * diagonal);
    const Mesh whole = build_mesh(TriangleMesh{fine.positions, fine.triangles});
    EXPECT_EQ(whole.topology.euler_characteristic(), 0) << "borders do not open the surface";
    for (const EdgeKind kind : whole.topology.kind) ASSERT_EQ(kind, EdgeKind::smooth);
  }
}

TEST(PackedParts, PartsCombineWithColoursAndTexcoords) {
  gltf::MaterialMesh torus = parted_torus(true);
  Attribute colours{.components = 3, .values = {}};
  for (const Vec3f p : torus.mesh.positions)
    colours.values.insert(colours.values.end(), {std::round(128 + 90 * double{p.z}), std::round(128 + 70 * p.x), 30});
  torus.mesh.attributes.push_back(std::move(colours));
  torus.mesh.format.attributes.push_back(
      {.kind = AttributeKind::color, .type = ValueType::uint8, .normalized = true, .id = 2});
  const Packed packed = pack(torus, {.rms = wanted, .face_limit = 20'000});
  ASSERT_TRUE(packed.model) << packed.reason;
  const PackedModel model = read_packed(packed.glb);
  EXPECT_TRUE(model.has_texcoords() && model.has_colours());
  const FormattedMesh fine = decode_packed(model);
  gltf::Materials materials = gltf::flatten_with_materials(packed.glb, {}).materials;
  materials.of_triangle = materials_below(materials.of_triangle, fine.triangles.size());
  EXPECT_LE(wrong_faces(fine, materials), fine.triangles.size() / 200);
  const auto is_colour = [](const AttributeFormat& format) { return format.kind == AttributeKind::color; };
  const size_t colour = std::ranges::find_if(fine.format.attributes, is_colour) - fine.format.attributes.begin();
  ASSERT_LT(colour, 2U);
  const size_t texcoord = 1 - colour;
  double largest_of_colours = 0, largest_of_texcoords = 0;
  for (size_t p = 0; p < fine.positions.size(); ++p) {
    const Vec3f at = fine.positions[p];
    const double* value = &fine.attributes[colour].values[3 * p];
    largest_of_colours =
        std::max({largest_of_colours, std::abs(value[0] - 128 - 90 * at.z), std::abs(value[1] - 128 - 70 * at.x)});
    const double turn = fine.attributes[texcoord].values[2 * p] - test::turn_of(to_double(at));
    largest_of_texcoords = std::max(largest_of_texcoords, std::abs(turn - std::round(turn)));
  }
  EXPECT_LT(largest_of_colours, 6);
  EXPECT_LT(largest_of_texcoords, 0.005);
}

TEST(PackedParts, SurfaceIsSmoothAcrossBorders) {
  const std::string glb = packed_torus();
  const PackedModel model = read_packed(glb);
  EXPECT_TRUE(model.base.curves.empty());
  const Mesh fine = decode_detail(model.base, model.streams());
  for (const EdgeKind kind : fine.topology.kind) ASSERT_EQ(kind, EdgeKind::smooth);
}

TEST(PackedParts, RefinedScenesEqualTheDecodersLevels) {
  const std::string glb = packed_torus(true);
  const PackedModel model = read_packed(glb);
  const auto places = [](const TriangleMesh& mesh) {
    std::set<std::array<float, 3>> found;
    for (const Vec3f p : mesh.positions) found.insert({p.x, p.y, p.z});
    return found;
  };
  const std::string made =
      test::refined(glb, {{"levels", std::to_string(model.levels.size())}, {"output.compress", "none"}}).bytes;
  const gltf::MaterialMesh scene = gltf::flatten_with_materials(made, {});
  const FormattedMesh decoded = decode_packed(model);
  EXPECT_EQ(scene.mesh.triangles.size(), decoded.triangles.size());
  EXPECT_EQ(places(scene.mesh), places(decoded));
  EXPECT_EQ(wrong_faces(scene.mesh, scene.materials), [&] {
    gltf::Materials materials = gltf::flatten_with_materials(glb, {}).materials;
    materials.of_triangle = materials_below(materials.of_triangle, decoded.triangles.size());
    return wrong_faces(decoded, materials);
  }());
  const auto texcoords_at = [](const FormattedMesh& mesh) {
    std::map<std::array<float, 3>, std::set<std::pair<float, float>>> found;
    for (size_t p = 0; p < mesh.positions.size(); ++p) {
      const Vec3f at = mesh.positions[p];
      const double* value = &mesh.attributes.at(0).values[2 * p];
      found[{at.x, at.y, at.z}].emplace(static_cast<float>(value[0]), static_cast<float>(value[1]));
    }
    return found;
  };
  EXPECT_EQ(texcoords_at(scene.mesh), texcoords_at(decoded));
}

TEST(PackedParts, DracoAnswersNumberTheParts) {
  const std::string glb = packed_torus();
  FormattedMesh answer = read_draco(Refinement(glb, parse_query({{"levels", "2"}}), {}).run().bytes, {});
  ASSERT_TRUE(gltf::has_material_attribute(answer));
  gltf::Materials materials = gltf::flatten_with_materials(glb, {}).materials;
  materials.of_triangle = gltf::take_material_attribute(answer, materials.materials.size());
  EXPECT_GT(answer.triangles.size(), 500U);
  EXPECT_LE(wrong_faces(answer, materials), answer.triangles.size() / 50);
}

TEST(PackedParts, PlainDracoFilesKeepParts) {
  gltf::MaterialMesh cube{.mesh = {}};
  static_cast<TriangleMesh&>(cube.mesh) = test::cube();
  cube.materials.materials = {{.name = "a"}, {.name = "b"}};
  for (uint32_t t = 0; t < 12; ++t) cube.materials.of_triangle.push_back(t / 4 == 1 ? none : t / 8);
  const Packed packed = pack(cube, {.rms = 1e-2, .face_limit = 500});
  ASSERT_FALSE(packed.model);
  const gltf::MaterialMesh read = gltf::flatten_with_materials(packed.glb, {});
  EXPECT_EQ(read.materials.of_triangle, (std::vector<uint32_t>{none, none, none, none, 0, 0, 0, 0, 1, 1, 1, 1}));
  const std::optional<PlainModel> plain = read_plain_draco(packed.glb, {});
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->mesh.triangles.size(), 12U);
  EXPECT_EQ(build_mesh(TriangleMesh{plain->mesh.positions, plain->mesh.triangles}).topology.vertex_count, 8U)
      << "all parts are on one grid";
}

TEST(PackedParts, TruncatedFileKeepsTheBaseAndCompleteLevels) {
  const std::string glb = packed_torus();
  const PackedModel whole = read_packed(glb);
  const PackedModel cut = read_packed(std::string_view(glb).substr(0, glb.size() - 4), {.may_be_cut = true});
  ASSERT_EQ(cut.levels.size(), whole.levels.size() - 1);
  EXPECT_EQ(cut.base, whole.base);
}

TEST(PackedParts, PartsRoundTripExactly) {
  const test::PartedFixture made = test::parted_fixture();
  EXPECT_EQ(made.base_streams.size(), 2U);
  const PackedModel model = read_packed(made.glb);
  EXPECT_EQ(model.base, made.detail.base);
  EXPECT_EQ(model.base_bytes, made.base_streams[0].size() + made.base_streams[1].size());
  EXPECT_EQ(model.levels.at(0).vertices, 12U);
  EXPECT_EQ(test::decoded_triangles(model.base, model.streams()),
            test::decoded_triangles(made.detail.base, model.streams()));
}

TEST(PackedParts, PartsOfOneMaterialHaveNoBorder) {
  const test::PartedFixture made = test::parted_fixture();
  const PackedModel model = read_packed(test::with_json(made.glb, [](PartJson& json) {
    for (PartJson& primitive : json["meshes"][0]["primitives"]) primitive["material"] = 1;
  }));
  DetailBase whole = model.base;
  whole.triangles = {whole.triangles.positions, whole.triangles.triangles};
  const auto positions_of = [&](const DetailBase& base) { return decode_detail(base, model.streams()).positions; };
  EXPECT_EQ(positions_of(model.base), positions_of(whole));
  EXPECT_NE(positions_of(made.detail.base), positions_of(whole)) << "residuals at borders are those of a curve";
}

TEST(PackedParts, InconsistentPartsAreRefused) {
  const std::string glb = test::parted_fixture().glb;
  const auto expect = [&](const char* code, const std::function<void(PartJson & primitives)>& change) {
    EXPECT_EQ(refusal_of(glb, [&](PartJson& json) { change(json["meshes"][0]["primitives"]); }), code);
  };
  expect("read", [](PartJson&) {});
  expect("read", [](PartJson& primitives) { primitives[0].erase("material"); });
  expect("mesh_unsupported", [](PartJson& primitives) {
    primitives[1]["extensions"]["PAPILIO_detail"] = primitives[0]["extensions"]["PAPILIO_detail"];
    primitives[0]["extensions"].erase("PAPILIO_detail");
  });
  expect("mesh_not_gltf",
         [](PartJson& primitives) { primitives[1]["extensions"].erase("KHR_draco_mesh_compression"); });
  expect("mesh_unsupported", [](PartJson& primitives) { primitives[1]["attributes"]["TEXCOORD_0"] = 0; });
  expect("mesh_not_gltf", [](PartJson& primitives) { primitives.erase(1); });
  expect("mesh_not_gltf",
         [](PartJson& primitives) { std::swap(primitives[0]["indices"], primitives[0]["attributes"]["POSITION"]); });
  expect("mesh_unsupported", [](PartJson& primitives) {
    primitives[1]["extensions"]["PAPILIO_detail"] = primitives[0]["extensions"]["PAPILIO_detail"];
  });
  expect("mesh_not_gltf", [](PartJson& primitives) { primitives[1]["material"] = "red"; });
  expect("mesh_not_gltf", [](PartJson& primitives) { primitives.push_back(primitives[1]); });
}

}  // namespace
}  // namespace papilio::proto::detail
