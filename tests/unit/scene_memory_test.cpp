#include "tests/support/scene_memory.h"

#include <gtest/gtest.h>

#include "server/address_space.h"
#include "server/heap.h"
#include "tests/support/shapes.h"

namespace papilio::test {
namespace {

// What pages round up to, and what the first use of a library takes.
constexpr double slack = 1;  // MiB

TEST(SceneMemory, IsAtMostThatOfBothScenesAndTheCore) {
  if (server::is_sanitized) GTEST_SKIP() << "sanitizers keep what is freed";
  for (const MeasuredScene& scene : measured_scenes(torus(100, 100), torus(32, 32))) {
    const SceneMemory memory = measure_scene(scene.glb, scene.fields);
    EXPECT_LE(memory.taken, memory.allowed + slack) << scene.name;
    EXPECT_GT(memory.taken, 1) << scene.name;
  }
}

TEST(SceneMemory, IsAtMostThatOfBothScenesAndTheCoreInAServer) {
  if (server::is_sanitized) GTEST_SKIP() << "sanitizers keep what is freed";
  for (const MeasuredScene& scene : measured_scenes(torus(100, 100), torus(32, 32))) {
    const SceneMemory memory = measure_scene(scene.glb, scene.fields, [] { server::set_up_heap(1); });
    EXPECT_LE(memory.taken, memory.allowed + slack) << scene.name;
  }
}

TEST(SceneMemory, OfAPackedModelIsAtMostThatOfBothScenesAndTheCore) {
  if (server::is_sanitized) GTEST_SKIP() << "sanitizers keep what is freed";
  const MeasuredScene scene = measured_packed_model(torus(100, 100));
  const SceneMemory memory = measure_scene(scene.glb, scene.fields);
  EXPECT_LE(memory.taken, memory.allowed + slack);
  EXPECT_GT(memory.taken, 1);
}

}  // namespace
}  // namespace papilio::test
