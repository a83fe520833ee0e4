#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace papilio {
namespace {

TEST(Parallel, NumberOfPartsFollowsTheWork) {
  EXPECT_EQ(parts_of(0, 8), 1U);
  EXPECT_EQ(parts_of(least_per_thread, 8), 1U);
  EXPECT_EQ(parts_of(2 * least_per_thread, 8), 2U);
  EXPECT_EQ(parts_of(100 * least_per_thread, 8), 8U);
  EXPECT_EQ(parts_of(100 * least_per_thread, 0), 1U);
}

TEST(Parallel, PartsCoverTheRangeOnce) {
  for (uint32_t count : {0U, 1U, 7U, 1000U, 4'000'000'000U})
    for (uint32_t parts : {1U, 2U, 3U, 7U}) {
      struct Range {
        uint32_t part, first, last;
      };
      std::mutex access;
      std::vector<Range> ranges;
      for_each_part(parts, count, [&](uint32_t part, uint32_t first, uint32_t last) {
        const std::lock_guard lock(access);
        ranges.push_back({part, first, last});
      });
      ASSERT_EQ(ranges.size(), parts);
      std::ranges::sort(ranges, {}, &Range::part);
      uint32_t next = 0;
      for (const Range& range : ranges) {
        EXPECT_EQ(range.first, next);
        next = range.last;
      }
      EXPECT_EQ(next, count);
    }
}

TEST(Parallel, ExceptionOfTheLowestPartIsRethrown) {
  for (uint32_t failing = 0; failing < 3; ++failing) {
    int done = 0;
    std::mutex access;
    const auto work = [&](uint32_t part, uint32_t, uint32_t) {
      const std::lock_guard lock(access);
      ++done;
      if (part >= failing) throw std::runtime_error(std::to_string(part));
    };
    try {
      for_each_part(4, 1000, work);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::to_string(failing));
    }
    EXPECT_EQ(done, 4);
  }
}

}  // namespace
}  // namespace papilio
