#include "mesh/grid_step.h"

#include <gtest/gtest.h>

#include <random>

#include "proto/draco_reader.h"
#include "proto/quantization_box.h"
#include "tests/support/bumpy_sphere.h"
#include "tests/support/grid_positions.h"
#include "tests/support/libdraco_writer.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

Buffer<Vec3f> random_points(size_t count, Vec3d offset = {}) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(-1, 1);
  Buffer<Vec3f> points;
  for (size_t i = 0; i < count; ++i)
    points.push_back(to_float(offset + Vec3d{3 * side(random), side(random), 0.4 * side(random)}));
  return points;
}

TEST(GridStep, GridOfDracosEncoderIsFound) {
  for (const Vec3d offset : {Vec3d{}, Vec3d{4, -2, 0.5}}) {
    const Buffer<Vec3f> points = random_points(200, offset);
    for (int bits = 8; bits <= 16; ++bits) {
      const double step = test::longest_side(points) / ((1 << bits) - 1);
      EXPECT_NEAR(grid_step(test::on_grid(points, step)) / step, 1, 1e-5) << bits;
    }
  }
}

TEST(GridStep, GridOfOurStreamsIsFound) {
  const Mesh mesh = build_mesh(test::bumpy_sphere(3));
  const proto::QuantizationBox box = proto::quantization_box(mesh.positions);
  for (int bits = 8; bits <= 16; ++bits) {
    const std::string stream = test::write_with_libdraco(mesh, box, {.position_bits = bits}, 0);
    const double step = static_cast<double>(box.range) / ((1 << bits) - 1);
    EXPECT_NEAR(grid_step(proto::read_draco(stream, {}).positions) / step, 1, 1e-4) << bits;
  }
}

TEST(GridStep, FloatsAreOnNoGrid) {
  EXPECT_EQ(grid_step(random_points(1000)), 0);
  EXPECT_EQ(grid_step(build_mesh(test::bumpy_sphere(3)).positions), 0);
}

// Measures in tenths of a millimetre; thirds and fifths of the whole, which are on Draco's grids too.
TEST(GridStep, RoundMeasuresAreNoGrid) {
  Buffer<Vec3f> tenths, fifteenths;
  for (uint32_t i = 0; i <= 500; ++i)
    tenths.push_back({0.1F * static_cast<float>(i), 0, 0.1F * static_cast<float>(i % 7)});
  for (uint32_t i = 0; i <= 15; ++i)
    fifteenths.push_back({static_cast<float>(i) / 15, static_cast<float>(i % 4) / 3, 0});
  EXPECT_EQ(grid_step(tenths), 0);
  EXPECT_EQ(grid_step(fifteenths), 0);
}

TEST(GridStep, FewOrEqualPointsAreNoGrid) {
  EXPECT_EQ(grid_step(test::on_grid(random_points(6), 6.0 / 1023)), 0);
  EXPECT_EQ(grid_step(Buffer<Vec3f>(30, Vec3f{1, 2, 3})), 0);
  EXPECT_EQ(grid_step(test::box({1, 1, 1}, {1, 2, 3}).positions), 0);
}

}  // namespace
}  // namespace papilio
