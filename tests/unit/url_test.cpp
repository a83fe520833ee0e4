#include "proto/url.h"

#include <gtest/gtest.h>

#include <string>

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

}  // namespace
}  // namespace papilio::proto
