#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "client/mesh_file/mesh_file.h"
#include "papilio/refine.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"

// Every mesh of libcgal-demo's data folder is refined without cracks or refused with a reason. Prints a table.

namespace papilio {
namespace {

using namespace test;
namespace fs = std::filesystem;

/// Loads a mesh; expects a reason if it cannot be read.
std::optional<Mesh> load(const fs::path& path, BuildReport& report) {
  std::string reason;
  try {
    return build_mesh(client::read_triangles(path, client::format_of(path)), &report);
  } catch (const client::FileError& error) {
    reason = error.what();
  } catch (const Error& error) {
    reason = error.what();
  }
  EXPECT_GT(reason.size(), 20U) << path << ": the reason is too short";
  std::printf("%-32s refused: %s\n", path.filename().c_str(), reason.c_str());
  return std::nullopt;
}

uint32_t count_shared(const Mesh& mesh) {
  return static_cast<uint32_t>(std::ranges::count(mesh.topology.kind, EdgeKind::shared));
}

/// Refines and checks a mesh. Returns the number of faces.
uint32_t refine_and_check(const Mesh& coarse, const Options& options) {
  const Mesh fine = refine(coarse, options).mesh;
  EXPECT_TRUE(is_consistent(fine));
  EXPECT_EQ(fine.topology.euler_characteristic(), coarse.topology.euler_characteristic());
  EXPECT_TRUE(std::equal(coarse.positions.begin(), coarse.positions.end(), fine.positions.begin()));
  for (Vec3f p : fine.positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
  EXPECT_EQ(count_shared(fine) == 0, count_shared(coarse) == 0);
  return fine.topology.face_count();
}

TEST(EveryRealMesh, ResultHasNoCracksOrInputIsRefused) {
  std::printf("%-32s %7s %7s %6s %7s %7s %7s %7s %7s %8s %8s %8s\n", "", "V", "F", "chi", "rim", "shared", "turned",
              "pinched", "dropped", "uniform", "red-gr.", "in-place");
  uint32_t refined = 0;
  for (const fs::path& path : cgal_mesh_files()) {
    SCOPED_TRACE(path.filename());
    BuildReport found;
    const std::optional<Mesh> coarse = load(path, found);
    if (!coarse) continue;
    ++refined;
    const Topology& mesh = coarse->topology;
    const uint32_t uniform = refine_and_check(*coarse, {.levels = 1});
    EXPECT_EQ(uniform, 4 * mesh.face_count());
    const uint32_t red_green = refine_and_check(*coarse, {.levels = 2, .tolerance = 1e-3});
    const uint32_t in_place =
        refine_and_check(*coarse, {.levels = 2, .scheme = Scheme::in_place, .flatness = {0.6, 0.8}});
    std::printf("%-32s %7u %7u %6lld %7u %7u %7u %7u %7u %8u %8u %8u\n", path.filename().c_str(), mesh.vertex_count,
                mesh.face_count(), static_cast<long long>(mesh.euler_characteristic()), found.boundary_edges,
                found.non_manifold_edges, found.misoriented_edges, found.pinched_vertices,
                found.degenerate_faces + found.repeated_faces + found.isolated_points, uniform, red_green, in_place);
  }
  EXPECT_GT(refined, 100U);
}

}  // namespace
}  // namespace papilio
