#include "proto/url.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proto/problem.h"

namespace papilio::proto {
namespace {

TEST(Url, DecodingUndoesEncodingOfEveryByte) {
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  EXPECT_EQ(decode_url(encode_url(all)), all);
  EXPECT_EQ(decode_url(encode_url(all), true), all);
}

TEST(Url, DigitsMayBeOfEitherCase) { EXPECT_EQ(decode_url("%4a%4A%e2%82%AC"), "JJ€"); }

TEST(Url, PlusIsASpaceOnlyInQueries) {
  EXPECT_EQ(decode_url("a+b%2B"), "a+b+");
  EXPECT_EQ(decode_url("a+b%2B", true), "a b+");
}

TEST(Url, PercentSignNeedsTwoDigits) {
  for (const char* bad : {"%", "a%", "%4", "50% off", "%4g", "%-1", "%+1", "%0x", "%%25", "% 1"})
    EXPECT_EQ(decode_url(bad), std::nullopt) << bad;
}

TEST(Url, QueriesAreSplitAndDecoded) {
  using Fields = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(split_query("a=1&b=x%2Cy+z&&c&d="), (Fields{{"a", "1"}, {"b", "x,y z"}, {"c", ""}, {"d", ""}}));
  EXPECT_EQ(split_query(""), Fields{});
  EXPECT_THROW((void)split_query("a=%2"), Problem);
}

}  // namespace
}  // namespace papilio::proto
