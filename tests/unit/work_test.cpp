#include "server/work.h"

#include <gtest/gtest.h>

namespace papilio::server {
namespace {

constexpr uint64_t faces = 600;

TEST(Work, UniformWorkIsExact) {
  for (int levels = 0; levels <= 6; ++levels) {
    Options options;
    options.levels = levels;
    const Work work = predicted_work(faces, options, {});
    EXPECT_EQ(work.expected, work.most);
    EXPECT_EQ(work.most <= small_work, levels <= 5) << levels;
  }
}

TEST(Work, AdaptiveWorkHasAnExpectedValueAndABound) {
  Options options;
  options.levels = 8;
  options.tolerance = 0.001;
  const Work work = predicted_work(faces, options, {});
  EXPECT_LE(work.expected, small_work);
  EXPECT_GT(work.most, 50 * small_work);
}

TEST(Work, LimitsBoundTheWork) {
  Options options;
  options.levels = 8;
  options.max_faces = 5000;
  const Work budget = predicted_work(faces, options, {});
  EXPECT_LE(budget.most, small_work);
  options.max_faces = 0;
  options.tolerance = 0.001;
  EXPECT_LT(predicted_work(faces, options, {.max_output_faces = 10'000}).most,
            predicted_work(faces, options, {.max_output_faces = 20'000}).most);
}

TEST(Work, RefusedUniformResultIsNoWork) {
  Options options;
  options.levels = 8;
  EXPECT_LE(predicted_work(faces, options, {}).most, small_work);
}

TEST(Work, UnrefinedLargeMeshIsLargeWork) {
  Options options;
  options.levels = 0;
  EXPECT_GT(predicted_work(2'000'000, options, {}).expected, small_work);
}

}  // namespace
}  // namespace papilio::server
