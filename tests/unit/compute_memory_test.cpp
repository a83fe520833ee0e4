#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <string>

#include "proto/draco_writer.h"
#include "proto/gltf/scene_refinement.h"
#include "proto/problem.h"
#include "proto/refinement.h"
#include "server/address_space.h"
#include "server/heap.h"
#include "tests/support/charts.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/shapes.h"

// `max_compute_bytes` bounds both ways: admitted requests need no more memory, and requests that need half of it are
// admitted. Each case runs in a process of its own with this memory limit.

namespace papilio::proto {
namespace {

using namespace test;

constexpr uint64_t slack = 12 << 20;  ///< bytes that do not depend on the mesh

enum Outcome : int { fits, refused, runs_out, fails };

uint64_t data_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmData:")) return std::stoull(line.substr(7)) << 10;
  return 0;
}

void refine_bytes(const std::string& bytes, const Parameters& parameters, const Limits& limits) {
  if (gltf::is_glb(bytes))
    (void)gltf::SceneRefinement(bytes, parameters, limits).run();
  else
    (void)Refinement(bytes, parameters, limits).run();
}

Outcome refine_within(const std::string& bytes, const QueryFields& fields, uint64_t limit, uint64_t memory) {
  const pid_t child = fork();
  if (child == 0) {
    server::set_up_heap(1);
    const rlimit data{data_bytes() + memory + slack, RLIM_INFINITY};
    setrlimit(RLIMIT_DATA, &data);
    try {
      refine_bytes(bytes, parse_query(fields), {.max_compute_bytes = limit});
      _exit(fits);
    } catch (const Problem& problem) {
      _exit(std::string(problem.what()).find("the limit is") != std::string::npos ? refused : runs_out);
    } catch (const std::bad_alloc&) {
      _exit(runs_out);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? static_cast<Outcome>(WEXITSTATUS(status)) : fails;
}

/// Returns the lowest limit that admits the request, within an eighth.
uint64_t lowest_limit(const std::string& bytes, const QueryFields& fields) {
  constexpr uint64_t plenty = uint64_t{8} << 30;
  uint64_t limit = 32 << 20;
  while (refine_within(bytes, fields, limit, plenty) == refused) limit += limit / 8;
  return limit;
}

FormattedMesh with_values(const TriangleMesh& plain, int attributes, uint32_t components, ValueType type) {
  FormattedMesh mesh;
  static_cast<TriangleMesh&>(mesh) = plain;
  for (int a = 0; a < attributes; ++a) {
    std::vector<double> values;
    for (size_t i = 0; i < plain.positions.size() * components; ++i)
      values.push_back(std::round(100 + 90 * std::sin(0.37 * static_cast<double>(i))));
    add_attribute(mesh, AttributeKind::generic, type, components, values);
  }
  return mesh;
}

std::string encoded(const FormattedMesh& mesh) { return write_draco_exact(mesh, mesh.format); }

/// A scene of one mesh with positions, or with all attributes of a skinned and textured mesh.
std::string scene_of(const TriangleMesh& mesh, bool skinned) {
  GltfScene scene;
  scene.add_mesh(mesh);
  const size_t count = mesh.positions.size();
  const auto numbers = [&](size_t components, float factor) {
    std::vector<float> all;
    for (size_t i = 0; i < count * components; ++i) all.push_back(std::sin(factor * static_cast<float>(i)));
    return all;
  };
  if (skinned) {
    auto& attributes = scene.primitive()["attributes"];
    attributes["NORMAL"] = scene.add_accessor(numbers(3, 0.37F), "VEC3");
    attributes["TEXCOORD_0"] = scene.add_accessor(numbers(2, 0.21F), "VEC2");
    attributes["JOINTS_0"] = scene.add_accessor(std::vector<uint8_t>(count * 4, 1), "VEC4");
    attributes["WEIGHTS_0"] = scene.add_accessor(std::vector<float>(count * 4, 0.25F), "VEC4");
  }
  return scene.glb();
}

struct Case {
  const char* name;
  std::string bytes;
  QueryFields fields;
};

std::vector<Case> scene_cases() {
  const std::string plain = scene_of(torus(16, 16), false);
  const std::string skinned = scene_of(torus(16, 16), true);
  const auto compressed = [](const char* name) { return QueryFields{{"levels", "5"}, {"output.compress", name}}; };
  return {{"plain scene", plain, compressed("same")},
          {"plain scene, meshopt", plain, compressed("meshopt")},
          {"plain scene, Draco", plain, compressed("draco")},
          {"skinned scene", skinned, compressed("same")},
          {"skinned scene, meshopt", skinned, compressed("meshopt")},
          {"skinned scene, Draco", skinned, compressed("draco")}};
}

std::vector<Case> cases() {
  const TriangleMesh plain = torus(16, 16);
  const std::string positions = write_draco_exact(plain);
  const QueryFields uniform{{"levels", "5"}};
  const auto with = [&](const char* name, const char* value) {
    QueryFields fields = uniform;
    fields.emplace_back(name, value);
    return fields;
  };
  return {{"positions", positions, uniform},
          {"slowest", positions, with("output.speed", "0")},
          {"normals", positions, with("output.normals", "true")},
          {"w", positions, with("w", "0.05")},
          {"tolerance", positions, {{"levels", "5"}, {"tolerance", "1e-9"}}},
          {"in place", positions, {{"levels", "5"}, {"tolerance", "1e-9"}, {"scheme", "in-place"}}},
          {"four float64", encoded(with_values(plain, 4, 8, ValueType::float64)), uniform},
          {"sixteen float32", encoded(with_values(plain, 16, 2, ValueType::float32)), uniform},
          {"one of bytes", encoded(with_values(plain, 1, 32, ValueType::uint8)), uniform},
          {"charts", encoded(charted_faces(plain)), uniform},
          {"float64, tolerance",
           encoded(with_values(plain, 4, 8, ValueType::float64)),
           {{"levels", "5"}, {"tolerance", "1e-9"}}}};
}

void expect_kept_and_used(const std::vector<Case>& all) {
  for (const Case& one : all) {
    const uint64_t limit = lowest_limit(one.bytes, one.fields);
    EXPECT_EQ(refine_within(one.bytes, one.fields, limit, limit), fits) << one.name << ": " << limit;
    EXPECT_EQ(refine_within(one.bytes, one.fields, limit, (limit - limit / 2) - slack), runs_out)
        << one.name << ": " << limit;
  }
}

TEST(ComputeMemory, MemoryIsBetweenHalfTheLimitAndTheLimit) {
  if (server::is_sanitized) GTEST_SKIP() << "sanitizers reserve terabytes";
  expect_kept_and_used(cases());
}

TEST(ComputeMemory, SceneMemoryIsBetweenHalfTheLimitAndTheLimit) {
  if (server::is_sanitized) GTEST_SKIP() << "sanitizers reserve terabytes";
  expect_kept_and_used(scene_cases());
}

TEST(ComputeMemory, UniformRequestIsRefusedBeforeTheWork) {
  const std::string draco = encoded(with_values(torus(16, 16), 4, 8, ValueType::float64));
  try {
    const Refinement refinement(draco, parse_query({{"levels", "7"}}), {.max_compute_bytes = uint64_t{1} << 30});
    FAIL() << "was not refused";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::result_too_large);
    EXPECT_NE(std::string(problem.what()).find("of memory; the limit is 1024 MiB"), std::string::npos)
        << problem.what();
  }
}

}  // namespace
}  // namespace papilio::proto
