#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "client/c/papilio.h"
#include "papilio/refine.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

/// A mesh in C structs.
struct Given {
  TriangleMesh mesh;
  std::vector<papilio_attribute> attributes{};

  [[nodiscard]] papilio_triangles triangles() const {
    return {.point_count = static_cast<uint32_t>(mesh.positions.size()),
            .face_count = static_cast<uint32_t>(mesh.triangles.size()),
            .attribute_count = static_cast<uint32_t>(attributes.size()),
            .positions = &mesh.positions[0].x,
            .triangles = mesh.triangles[0].data(),
            .attributes = attributes.data()};
  }
};

/// Owner of a mesh and its latest result.
struct Opened {
  papilio_mesh* mesh;
  papilio_result* result = nullptr;

  explicit Opened(const Given& given) {
    const papilio_triangles triangles = given.triangles();
    mesh = papilio_mesh_create(&triangles);
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  ~Opened() {
    papilio_result_free(result);
    papilio_mesh_free(mesh);
  }
  const papilio_result* refine(const char* parameters, const papilio_hooks* hooks = nullptr) {
    papilio_result_free(result);
    return result = papilio_refine(mesh, parameters, hooks);
  }
};

void expect_same(const papilio_triangles& made, const TriangleMesh& expected) {
  ASSERT_EQ(made.point_count, expected.positions.size());
  ASSERT_EQ(made.face_count, expected.triangles.size());
  EXPECT_EQ(std::memcmp(made.positions, expected.positions.data(), sizeof(Vec3f) * made.point_count), 0);
  EXPECT_EQ(std::memcmp(made.triangles, expected.triangles.data(), sizeof(Triangle) * made.face_count), 0);
}

TEST(CFunctions, ResultsEqualTheCores) {
  Opened opened({test::torus(9, 7)});
  ASSERT_NE(opened.mesh, nullptr);
  for (const char* parameters :
       {"levels=2", "levels=3&tolerance=0.001", "levels=3&view.eye=0%2C0%2C3&tolerance=0.01", ""}) {
    ASSERT_NE(opened.refine(parameters), nullptr) << papilio_last_message();
    Options options{.edges = false};
    if (std::strstr(parameters, "levels=3") != nullptr) options.levels = 3;
    if (std::strstr(parameters, "tolerance=0.001") != nullptr) options.tolerance = 0.001;
    if (std::strstr(parameters, "view") != nullptr) {
      options.tolerance = 0.01;
      options.view = View{.target = bounding_box(test::torus(9, 7).positions).centre()};
    }
    const Result expected = refine(build_mesh(test::torus(9, 7)), options);
    expect_same(*papilio_result_mesh(opened.result), expected.mesh.triangles());
    const papilio_statistics& statistics = *papilio_result_statistics(opened.result);
    EXPECT_EQ(statistics.level, expected.levels);
    EXPECT_EQ(statistics.is_last, 1);
    EXPECT_EQ(statistics.stop_reason, static_cast<int32_t>(expected.stop_reason));
    EXPECT_EQ(statistics.error, expected.error);
    EXPECT_EQ(statistics.error_pixels, expected.error_pixels);
    EXPECT_EQ(statistics.components, expected.shape.components);
  }
  EXPECT_STREQ(papilio_version(), PAPILIO_VERSION);
}

TEST(CFunctions, AttributesKeepTheirOrder) {
  Given given{test::torus(9, 7)};
  const size_t points = given.mesh.positions.size();
  std::vector<double> places(2 * points), normals(3 * points), moves(3 * points);
  for (size_t p = 0; p < points; ++p) {
    places[2 * p] = given.mesh.positions[p].x;
    normals[3 * p + 2] = 1;
    moves[3 * p + 1] = 0.5;
  }
  given.attributes = {{2, PAPILIO_VALUES, places.data()},
                      {3, PAPILIO_NORMALS, normals.data()},
                      {3, PAPILIO_DISPLACEMENTS, moves.data()}};
  Opened opened(given);
  ASSERT_NE(opened.refine("levels=1&shape=plain&output.normals=true"), nullptr) << papilio_last_message();
  const papilio_triangles& made = *papilio_result_mesh(opened.result);
  ASSERT_EQ(made.attribute_count, 3U);
  for (size_t a = 0; a < 3; ++a) {
    EXPECT_EQ(made.attributes[a].components, given.attributes[a].components);
    EXPECT_EQ(made.attributes[a].kind, given.attributes[a].kind);
  }
  // Displacements are equal everywhere; normals follow the surface.
  EXPECT_NEAR(made.attributes[2].values[3 * made.point_count - 2], 0.5, 1e-6);
  EXPECT_NE(made.attributes[1].values[2], 1);

  Opened without({test::torus(9, 7)});
  ASSERT_NE(without.refine("levels=1&output.normals=true"), nullptr);
  ASSERT_EQ(papilio_result_mesh(without.result)->attribute_count, 1U);
  EXPECT_EQ(papilio_result_mesh(without.result)->attributes[0].kind, PAPILIO_NORMALS);
}

TEST(CFunctions, LevelsAreReportedAndTheCallerMayStop) {
  struct Seen {
    std::vector<uint32_t> faces;
    std::vector<int32_t> levels, last;
    int asked = 0;
  } seen;
  papilio_hooks hooks{.user = &seen,
                      .cancelled = nullptr,
                      .on_level =
                          [](void* user, const papilio_triangles* mesh, const papilio_statistics* statistics) {
                            auto& all = *static_cast<Seen*>(user);
                            all.faces.push_back(mesh->face_count);
                            all.levels.push_back(statistics->level);
                            all.last.push_back(statistics->is_last);
                          },
                      .threads = 2};
  Opened opened({test::torus(9, 7)});
  ASSERT_NE(opened.refine("levels=2", &hooks), nullptr);
  EXPECT_EQ(seen.faces, (std::vector<uint32_t>{126, 504, 2016}));
  EXPECT_EQ(seen.levels, (std::vector<int32_t>{0, 1, 2}));
  EXPECT_EQ(seen.last, (std::vector<int32_t>{0, 0, 1}));

  hooks.on_level = nullptr;
  hooks.cancelled = [](void* user) { return ++static_cast<Seen*>(user)->asked > 1 ? 1 : 0; };
  EXPECT_EQ(opened.refine("levels=5&tolerance=0.000001", &hooks), nullptr);
  EXPECT_EQ(papilio_last_fault(), PAPILIO_CANCELLED);
  EXPECT_EQ(seen.asked, 2);
}

TEST(CFunctions, FailuresStateTheRemedy) {
  Opened opened({test::torus(9, 7)});
  const auto fails = [&](const char* parameters, papilio_fault fault, const std::string& words, const char* parameter) {
    EXPECT_EQ(opened.refine(parameters), nullptr);
    EXPECT_EQ(papilio_last_fault(), fault) << parameters;
    EXPECT_NE(std::string(papilio_last_message()).find(words), std::string::npos) << papilio_last_message();
    EXPECT_STREQ(papilio_last_parameter(), parameter);
  };
  fails("levels=99", PAPILIO_BAD_PARAMETER, "0..10", "levels");
  fails("tolerence=1", PAPILIO_BAD_PARAMETER, "Did you mean", "tolerence");
  fails("levels=%zz", PAPILIO_BAD_PARAMETER, "hexadecimal", "");
  fails("levels=10", PAPILIO_TOO_LARGE, "limit is 16000000", "");

  Given broken{test::torus(9, 7)};
  broken.mesh.triangles[3][1] = 1000;
  EXPECT_EQ(Opened(broken).mesh, nullptr);
  EXPECT_EQ(papilio_last_fault(), PAPILIO_UNUSABLE_MESH);
  Given odd{test::torus(9, 7)};
  const std::vector<double> two(2 * odd.mesh.positions.size());
  odd.attributes = {{2, PAPILIO_NORMALS, two.data()}};
  EXPECT_EQ(Opened(odd).mesh, nullptr);
  EXPECT_STREQ(papilio_last_message(), "Normals have 3 components, not 2.");
  odd.attributes[0].kind = 9;
  EXPECT_EQ(Opened(odd).mesh, nullptr);
  EXPECT_STREQ(papilio_last_message(), "Unknown kind of attribute: 9.");
}

}  // namespace
}  // namespace papilio
