#include "proto/draco_attributes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <set>

#include "papilio/refine.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "proto/problem.h"
#include "proto/refinement.h"
#include "tests/support/charts.h"
#include "tests/support/draco_tools.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio::proto {
namespace {

using namespace test;

constexpr double texture_step = 11.0 / ((1 << 14) - 1);  // of the charted cube, with coordinates from 0 to 11

FormattedMesh repeat(FormattedMesh mesh, AttributeKind kind, ValueType type, const std::vector<double>& value) {
  std::vector<double> values;
  for (size_t p = 0; p < mesh.positions.size(); ++p) values.insert(values.end(), value.begin(), value.end());
  add_attribute(mesh, kind, type, static_cast<uint32_t>(value.size()), values);
  return mesh;
}

/// Returns the charted cube with additional attributes of every type, with random values.
FormattedMesh decorated_cube() {
  FormattedMesh mesh = charted_cube();
  std::mt19937 random(5);
  const auto add = [&](AttributeKind kind, ValueType type, uint32_t components, double low, double high) {
    std::vector<double> values;
    for (size_t i = 0; i < mesh.positions.size() * components; ++i) {
      const double value = std::uniform_real_distribution<double>(low, high)(random);
      values.push_back(type == ValueType::float64   ? value
                       : type == ValueType::float32 ? static_cast<float>(value)
                                                    : std::round(value));
    }
    add_attribute(mesh, kind, type, components, values);
  };
  add(AttributeKind::color, ValueType::uint8, 4, 0, 255);
  mesh.format.attributes.back().normalized = true;
  add(AttributeKind::generic, ValueType::int8, 1, -128, 127);
  add(AttributeKind::generic, ValueType::int16, 3, -32768, 32767);
  add(AttributeKind::generic, ValueType::uint16, 1, 0, 65535);
  add(AttributeKind::generic, ValueType::int32, 2, -2147483648.0, 2147483647.0);
  add(AttributeKind::generic, ValueType::uint32, 1, 0, 2147483647.0);
  add(AttributeKind::generic, ValueType::int64, 1, -4e15, 4e15);
  add(AttributeKind::generic, ValueType::uint64, 1, 0, 9e15);
  add(AttributeKind::generic, ValueType::float32, 4, -1000, 1000);
  add(AttributeKind::generic, ValueType::float64, 2, -1e300, 1e300);
  add(AttributeKind::generic, ValueType::boolean, 1, 0, 1);
  mesh.format.attributes.back().name = "a flag";
  mesh.format.attributes[chart_number].id = 77;
  mesh.format.position_id = 5;
  return mesh;
}

std::string write(const Mesh& mesh, const Mesh& coarse, const MeshFormat& format, const OutputOptions& options = {}) {
  return write_draco(mesh, quantization_box(coarse.positions), options, attribute_encoding(coarse, format));
}

/// Returns the largest error of a written value.
double tolerance_of(const Attribute& attribute, const AttributeFormat& format) {
  if (format.kind == AttributeKind::tex_coord) return 0.51 * texture_step;
  if (format.type == ValueType::float32) return attribute.unit_length ? 0.01 : 2000.0 / 65535 * 0.51;
  return format.type == ValueType::float64 ? 0 : 0.5;
}

/// Expects every corner of `read` to equal the corner of `mesh` with its chart and position. Edgebreaker reorders
/// corners and faces.
void expect_same_corners(const FormattedMesh& read, const TriangleMesh& mesh, const MeshFormat& format) {
  ASSERT_EQ(read.format, format);
  ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
  const auto at = [](const TriangleMesh& m, size_t a, size_t p, size_t i) {
    return m.attributes[a].values[p * m.attributes[a].components + i];
  };
  for (uint32_t p = 0; p < read.positions.size(); ++p) {
    uint32_t found = none;
    for (uint32_t q = 0; q < mesh.positions.size(); ++q)
      if (at(read, 0, p, 0) == at(mesh, 0, q, 0) &&
          std::hypot(at(read, 1, p, 0) - at(mesh, 1, q, 0), at(read, 1, p, 1) - at(mesh, 1, q, 1)) < 2 * texture_step)
        found = q;
    ASSERT_NE(found, none) << p;
    ASSERT_LE(length(to_double(read.positions[p]) - to_double(mesh.positions[found])), 1e-4);
    for (size_t a = 0; a < mesh.attributes.size(); ++a)
      for (uint32_t i = 0; i < mesh.attributes[a].components; ++i)
        ASSERT_NEAR(at(read, a, p, i), at(mesh, a, found, i), tolerance_of(mesh.attributes[a], format.attributes[a]))
            << "attribute " << a << " component " << i;
  }
}

TEST(DracoAttributes, EveryTypeRoundTripsAtEverySpeed) {
  const FormattedMesh input = decorated_cube();
  const Mesh coarse = build_mesh(input);
  for (const Options& options : {Options{.levels = 0}, Options{.levels = 2}, Options{.levels = 3, .flatness = {0.5}}}) {
    const Mesh fine = refine(coarse, options).mesh;
    for (int speed = 0; speed <= 10; ++speed) {
      SCOPED_TRACE(speed);
      const std::string bytes = write(fine, coarse, input.format, {.speed = speed});
      const FormattedMesh read = read_draco(bytes, {});
      expect_same_corners(read, fine.triangles(), input.format);
      EXPECT_TRUE(tiles_its_charts(read, 1, 20 * texture_step));
      const Mesh built = build_mesh(read);
      EXPECT_EQ(built.topology.vertex_count, fine.topology.vertex_count);
      EXPECT_EQ(built.topology.euler_characteristic(), 2);
      EXPECT_EQ(built.attributes.point_count, fine.attributes.point_count);
    }
  }
}

TEST(DracoAttributes, DracoDecoderSeesOnePositionAVertex) {
  FormattedMesh input = charted_cube();
  std::vector<double> normals;
  for (uint32_t p = 0; p < 24; ++p)
    for (uint32_t i = 0; i < 3; ++i) normals.push_back((2 - i) == p / 8 ? (p / 4 % 2 == 0 ? -1 : 1) : 0);
  add_attribute(input, AttributeKind::normal, ValueType::float32, 3, normals);
  const Mesh coarse = build_mesh(input);
  const Mesh fine = refine(coarse, {.levels = 2}).mesh;
  for (int speed : {0, 3, 5, 7, 10}) {
    size_t positions = 0;
    const FormattedMesh seen = decode_to_obj(write(fine, coarse, input.format, {.speed = speed}), &positions);
    EXPECT_EQ(positions, fine.topology.vertex_count) << "a position is written twice";
    EXPECT_EQ(seen.triangles.size(), 192U);
    EXPECT_EQ(build_mesh(seen).attributes.point_count, fine.attributes.point_count);
    ASSERT_EQ(seen.attributes.size(), 2U);
    const auto& texture = seen.attributes[0].values;
    const auto& normal = seen.attributes[1].values;
    for (uint32_t p = 0; p < seen.positions.size(); ++p) {
      const auto side = static_cast<uint32_t>((texture[2 * p] + 0.5) / 2);
      EXPECT_NEAR(normal[3 * p + 2 - side / 2], side % 2 == 0 ? -1 : 1, 1e-2);
      // Interpolated values are multiples of a quarter of a side.
      for (double t : {texture[2 * p], texture[2 * p + 1]})
        EXPECT_NEAR(4 * t, std::round(4 * t), 4 * 0.51 * texture_step + 1e-5);
    }
  }
}

TEST(DracoAttributes, StreamsOfDracoEncoderAreRead) {
  const FormattedMesh input = charted_cube();
  for (int compression : {0, 3, 7, 10}) {
    const FormattedMesh read = read_draco(encode_with_draco_encoder(input, compression), {});
    ASSERT_EQ(read.attributes.size(), 1U);
    EXPECT_EQ(read.format.attributes[0].kind, AttributeKind::tex_coord);
    const Mesh built = build_mesh(read);
    EXPECT_EQ(built.topology.vertex_count, 8U);
    EXPECT_EQ(built.attributes.point_count, 24U);
  }
}

TEST(DracoAttributes, CoarseValuesAreUnchangedInFinerLevels) {
  const FormattedMesh input = charted_faces(real_mesh("bunny600.obj"));
  const Mesh coarse = build_mesh(input);
  const auto values = [&](int levels) {
    const FormattedMesh read = read_draco(write(refine(coarse, {.levels = levels}).mesh, coarse, input.format), {});
    std::set<std::array<double, 3>> all;
    for (size_t p = 0; p < read.positions.size(); ++p)
      all.insert(
          {read.attributes[0].values[p], read.attributes[1].values[2 * p], read.attributes[1].values[2 * p + 1]});
    return all;
  };
  const auto first = values(0);
  const auto second = values(2);
  EXPECT_EQ(first.size(), 1800U);
  EXPECT_TRUE(std::ranges::includes(second, first));
}

TEST(DracoAttributes, ExtremeValuesGiveReadableStreams) {
  const float most = std::numeric_limits<float>::max();
  const FormattedMesh cube = charted_cube();
  std::vector<FormattedMesh> inputs{
      repeat(cube, AttributeKind::generic, ValueType::float32, {0}),
      repeat(cube, AttributeKind::generic, ValueType::float32, {most, -most}),
      repeat(cube, AttributeKind::generic, ValueType::uint32, {4294967295.0}),
      repeat(cube, AttributeKind::generic, ValueType::int32, {-2147483648.0, 2147483647.0}),
      repeat(cube, AttributeKind::generic, ValueType::int64, {-9.3e18, 9.3e18}),
      repeat(cube, AttributeKind::generic, ValueType::uint64, {1.9e19}),
      repeat(cube, AttributeKind::generic, ValueType::uint8, std::vector<double>(29, 7)),
      repeat(cube, AttributeKind::normal, ValueType::float32, {0, 0, 0}),
      repeat(cube, AttributeKind::normal, ValueType::float32, {0, 1}),
      repeat(cube, AttributeKind::normal, ValueType::float64, {0, 1, 0}),
      repeat(cube, AttributeKind::normal, ValueType::int8, {0, 127, 0}),
      repeat(cube, AttributeKind::tex_coord, ValueType::float32, {1}),
      repeat(cube, AttributeKind::tex_coord, ValueType::float32, {1, 2, 3}),
      repeat(cube, AttributeKind::tex_coord, ValueType::uint16, {1, 65535}),
      repeat(cube, AttributeKind::color, ValueType::float32, {most, 1, 0}),
  };
  for (size_t i = 0; i < inputs.size(); ++i) {  // a second value, so that refinement interpolates
    FormattedMesh spread = inputs[i];
    std::vector<double>& values = spread.attributes.back().values;
    for (size_t k = 0; k < values.size() / 2; ++k) values[k] = -values[k];
    if (i < 15) inputs.push_back(spread);
  }
  for (size_t i = 0; i < inputs.size(); ++i) {
    const Mesh coarse = build_mesh(inputs[i]);
    const Mesh fine = refine(coarse, {.levels = 2}).mesh;
    for (int speed = 0; speed <= 10; ++speed) {
      SCOPED_TRACE(std::to_string(i) + " at " + std::to_string(speed));
      const FormattedMesh read = read_draco(write(fine, coarse, inputs[i].format, {.speed = speed}), {});
      EXPECT_EQ(read.format, inputs[i].format);
      EXPECT_EQ(build_mesh(read).topology.vertex_count, fine.topology.vertex_count);
      EXPECT_TRUE(tiles_its_charts(read, 1, 20 * texture_step));
    }
    const FormattedMesh exact = read_draco(write_draco_exact(inputs[i], inputs[i].format), {});
    EXPECT_EQ(exact.format, inputs[i].format);
  }
}

// libdraco predicted them as octahedral coordinates of two numbers: values changed, and with one number it wrote out of
// bounds.
TEST(DracoAttributes, IntegerNormalsOfAnyLengthRoundTrip) {
  std::mt19937 random(3);
  for (uint32_t components = 1; components <= 4; ++components) {
    FormattedMesh input = charted_cube();
    std::vector<double> values(input.positions.size() * components);
    for (double& value : values) value = std::uniform_int_distribution<int>(-128, 127)(random);
    add_attribute(input, AttributeKind::normal, ValueType::int8, components, values);
    const Mesh mesh = build_mesh(input);
    for (int speed = 0; speed <= 10; ++speed) {
      SCOPED_TRACE(std::to_string(components) + " at " + std::to_string(speed));
      expect_same_corners(read_draco(write(mesh, mesh, input.format, {.speed = speed}), {}), input, input.format);
    }
  }
}

// libdraco allocated two billion orientations of texture coordinates for a stream of 255 bytes.
TEST(DracoAttributes, SuperfluousOrientationsAreRefused) {
  const FormattedMesh input = charted_cube();
  const Mesh mesh = build_mesh(input);
  const std::string sound = write(mesh, mesh, input.format, {.speed = 0});
  const auto is_refused_at = [&](size_t place) {
    std::string damaged = sound;
    damaged.replace(place, 4, std::string("\0\0\0\1", 4));  // 2^24
    try {
      (void)read_draco(damaged, {});
    } catch (const Problem& problem) {
      return std::string_view(problem.what()).find("invalid prediction") != std::string_view::npos;
    } catch (const Error&) {
    }
    return false;
  };
  size_t refused = 0;
  for (size_t place = 0; place + 4 <= sound.size(); ++place) refused += is_refused_at(place) ? 1 : 0;
  EXPECT_GE(refused, 1U);
  EXPECT_EQ(read_draco(sound, {}).format, input.format);
}

TEST(DracoAttributes, MeshesOfEveryKindKeepFacesAndCharts) {
  TriangleMesh misoriented = icosahedron();
  std::swap(misoriented.triangles[3][0], misoriented.triangles[3][1]);
  TriangleMesh non_manifold = cube();
  non_manifold.positions.push_back({0.5F, 0.5F, 3});
  non_manifold.triangles.push_back({0, 1, 8});
  std::vector<TriangleMesh> shapes{misoriented, non_manifold, join(cube(), fan(5, false), 4), grid(3, 3)};
  for (uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    shapes.push_back(random_manifold(random));
  }
  for (const TriangleMesh& shape : shapes) {
    const FormattedMesh input = charted_faces(shape);
    const std::string exact = write_draco_exact(input, input.format);
    for (int speed : {0, 3, 5, 7, 10}) {
      const EncodedLevel made =
          Refinement(exact, {.options = {.levels = 1}, .output = {.speed = speed}}, Limits{}).run();
      const FormattedMesh read = read_draco(made.bytes, {});
      EXPECT_EQ(read.triangles.size(), made.statistics.faces);
      EXPECT_EQ(build_mesh(read).topology.vertex_count, made.statistics.vertices);
      EXPECT_TRUE(tiles_its_charts(read, 0.5, 1e-3));
    }
  }
}

TEST(DracoAttributes, ExactValuesRoundTripBitIdentically) {
  const FormattedMesh input = decorated_cube();
  const FormattedMesh read = read_draco(write_draco_exact(input, input.format), {});
  EXPECT_EQ(read.format, input.format);
  for (size_t a = 0; a < input.attributes.size(); ++a) {
    const std::set<double> before(input.attributes[a].values.begin(), input.attributes[a].values.end());
    EXPECT_EQ(std::set<double>(read.attributes[a].values.begin(), read.attributes[a].values.end()), before) << a;
  }
}

Problem problem_of(const FormattedMesh& mesh) {
  try {
    (void)Refinement(write_draco_exact(mesh, mesh.format), {}, Limits{});
  } catch (const Problem& problem) {
    return problem;
  }
  ADD_FAILURE() << "was not refused";
  return {Code::internal, ""};
}

TEST(DracoAttributes, CountsAboveTheLimitsAreRefused) {
  FormattedMesh many = charted_cube();
  while (many.attributes.size() < 17) many = repeat(many, AttributeKind::generic, ValueType::uint8, {1});
  EXPECT_EQ(problem_of(many).code(), Code::mesh_too_large);
  EXPECT_STREQ(problem_of(many).what(),
               "The mesh has 18 attributes, positions included; the limit is 17. Remove attributes.");
  try {  // truncated within the values: refused before they are decoded
    const std::string bytes = write_draco_exact(many, many.format);
    (void)read_draco(std::string_view(bytes).substr(0, bytes.size() - 20), {});
    ADD_FAILURE() << "was not refused";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::mesh_too_large);
  }
  const std::vector<double> wide(30, 1);
  EXPECT_EQ(problem_of(repeat(charted_cube(), AttributeKind::generic, ValueType::float32, wide)).code(),
            Code::mesh_too_large);
}

#if defined(__SANITIZE_THREAD__)
constexpr int damaged_streams = 200;  // one thread reads them: two minutes with more
#else
constexpr int damaged_streams = 2000;
#endif

TEST(DracoAttributes, DamagedStreamsNeverCrash) {
  const FormattedMesh input = decorated_cube();
  const Mesh coarse = build_mesh(input);
  for (int speed : {0, 5, 10}) {
    const std::string bytes = write(refine(coarse, {.levels = 1}).mesh, coarse, input.format, {.speed = speed});
    std::mt19937 random(1);
    for (int i = 0; i < damaged_streams; ++i) {
      std::string damaged = bytes;
      for (uint32_t n = 1 + random() % 4; n > 0; --n) damaged[random() % damaged.size()] = static_cast<char>(random());
      try {
        const FormattedMesh mesh = read_draco(damaged, {.max_input_faces = 10000, .max_input_vertices = 10000});
        for (const Attribute& attribute : mesh.attributes)
          ASSERT_EQ(attribute.values.size(), mesh.positions.size() * attribute.components);
        const Mesh built = build_mesh(mesh);
        (void)write(built, built, mesh.format, {.speed = speed});
      } catch (const Problem& problem) {
        EXPECT_NE(problem.code(), Code::internal);
      } catch (const Error& error) {
        EXPECT_GT(std::string(error.what()).size(), 20U);
      }
    }
  }
}

TEST(DracoAttributes, NonFiniteValuesAreRefusedByAttribute) {
  FormattedMesh mesh = charted_cube();
  std::string bytes = write_draco_exact(mesh, mesh.format);
  // Exact streams have raw floats: NaN replaces 11.
  const float from = 11;
  const float to = std::nanf("");
  const size_t at = bytes.find(std::string_view(reinterpret_cast<const char*>(&from), sizeof from));
  ASSERT_NE(at, std::string::npos);
  std::memcpy(bytes.data() + at, &to, sizeof to);
  try {
    (void)Refinement(bytes, {}, Limits{});
    FAIL() << "was not refused";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::mesh_unusable);
    EXPECT_NE(std::string(problem.what()).find("Attribute 1"), std::string::npos);
  }
}

}  // namespace
}  // namespace papilio::proto
