#include "tests/support/detail_baseline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proto/draco_reader.h"
#include "tests/support/shapes.h"

namespace papilio::test {
namespace {

TEST(DetailBaseline, LadderDescendsFromTheOriginal) {
  EXPECT_EQ(size_ladder(1000, 0.5, 200), (std::vector<size_t>{1000, 500, 250}));
  EXPECT_TRUE(size_ladder(100, 0.5, 200).empty());
}

constexpr size_t few_samples = 5000;

TEST(DetailBaseline, PlainDracoHalvesTheDistanceWithEachBit) {
  const std::vector<RatePoint> points = plain_draco({"torus", torus(60, 30), few_samples});
  ASSERT_EQ(points.size(), 9U);
  for (size_t i = 1; i < points.size(); ++i) {
    EXPECT_EQ(points[i].bits, points[i - 1].bits + 1);
    EXPECT_GT(points[i].bytes, points[i - 1].bytes);
    EXPECT_LT(points[i].rms, points[i - 1].rms);
  }
  EXPECT_NEAR(points.front().rms / points.back().rms, 256, 50);
}

TEST(DetailBaseline, FacesLostOnTheGridAreNotSent) {
  const TriangleMesh mesh = torus(300, 150);
  const size_t sent = proto::read_draco(smallest_draco(mesh, 5), {}).triangles.size();
  EXPECT_LT(sent, mesh.triangles.size());
  EXPECT_EQ(proto::read_draco(smallest_draco(mesh, 14), {}).triangles.size(), mesh.triangles.size());
}

TEST(DetailBaseline, BetterCollapsesAreSmallerAtEqualDistance) {
  const DetailSubject subject("torus", torus(60, 30), few_samples);
  std::vector<double> bytes;
  for (const DetailMethod& method : detail_baselines()) {
    const auto found = at_rms(lower_envelope(method.points(subject)), 0.2);
    ASSERT_TRUE(found) << method.name;
    bytes.push_back(found->bytes);
  }
  ASSERT_EQ(bytes.size(), 4U);
  EXPECT_LT(bytes[2], bytes[1]) << "quadrics against meshoptimizer";
  EXPECT_LT(bytes[3], bytes[2]) << "memoryless against accumulated quadrics";
}

}  // namespace
}  // namespace papilio::test
