#include "server/accept.h"

#include <gtest/gtest.h>

namespace papilio::server {
namespace {

const std::vector<std::string> offered{"application/x-draco", "application/octet-stream", "multipart/mixed"};

TEST(Accept, TypeOfHighestQualityIsChosen) {
  const auto chosen = [](const char* accept) { return negotiate(accept, offered).value_or("none"); };
  EXPECT_EQ(chosen(""), "application/x-draco");
  EXPECT_EQ(chosen("*/*"), "application/x-draco");
  EXPECT_EQ(chosen("multipart/mixed"), "multipart/mixed");
  EXPECT_EQ(chosen("Multipart/Mixed; q=0.5"), "multipart/mixed");
  EXPECT_EQ(chosen("multipart/*"), "multipart/mixed");
  EXPECT_EQ(chosen("*/*, multipart/mixed"), "multipart/mixed");
  EXPECT_EQ(chosen("*/*;q=0.9, multipart/mixed;q=0.1"), "application/x-draco");
  EXPECT_EQ(chosen("application/octet-stream"), "application/octet-stream");
  EXPECT_EQ(chosen("application/*"), "application/x-draco");
  EXPECT_EQ(chosen("text/html, application/xhtml+xml"), "none");
  EXPECT_EQ(chosen("application/x-draco;q=0"), "none");
  EXPECT_EQ(chosen("application/x-draco;q=0, */*"), "application/octet-stream");
  EXPECT_EQ(chosen("model/vnd;q=x, ;;, ,"), "none");
}

TEST(Accept, GzipRequiresItsNameOrAWildcard) {
  for (const char* yes : {"gzip", "br, gzip", "deflate;q=0.5, GZIP;q=0.1", "*", "x-gzip", "*;q=0, gzip"})
    EXPECT_TRUE(accepts_gzip(yes)) << yes;
  for (const char* no : {"", "identity", "br", "gzip;q=0", "gzip;q=0, *", "*;q=0", "gzipped"})
    EXPECT_FALSE(accepts_gzip(no)) << no;
}

}  // namespace
}  // namespace papilio::server
