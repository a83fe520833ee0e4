#include "server/http/routes.h"

#include <gtest/gtest.h>

#include "server/http/byte_budget.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Problem;

class RoutesTest : public testing::Test {
 protected:
  RoutesTest() {
    for (const char* path : {"/a", "/a/{id}", "/a/{id}/b", "/a/known"})
      routes_.add("GET", path, [](Request&) { return Response{}; }, {});
    routes_.add("DELETE", "/a/{id}", [](Request&) { return Response{}; }, {.access = Access::manage});
  }
  [[nodiscard]] std::string pattern(const std::string& path) const {
    try {
      return routes_.find("GET", path).pattern;
    } catch (const Problem&) {
      return "none";
    }
  }
  Routes routes_;
};

TEST_F(RoutesTest, SegmentsInBracesStandForAnyText) {
  EXPECT_EQ(pattern("/a"), "/a");
  EXPECT_EQ(pattern("/a/17"), "/a/{id}");
  EXPECT_EQ(pattern("/a/known"), "/a/known");
  EXPECT_EQ(pattern("/a/known/b"), "/a/{id}/b");
  EXPECT_EQ(routes_.find("GET", "/a/17/b").parameters, (Fields{{"id", "17"}}));
  EXPECT_EQ(routes_.find("DELETE", "/a/17").route->options.access, Access::manage);
  for (const char* path : {"", "/", "/a/", "/a//b", "/a/17/", "/a/17/b/", "/a/17/b/c", "/b", "a", "/a/17/c"})
    EXPECT_EQ(pattern(path), "none") << path;
}

TEST_F(RoutesTest, BracesInAPathAreLiteral) {
  EXPECT_EQ(pattern("/a/{id}"), "/a/{id}");
  EXPECT_EQ(routes_.find("GET", "/a/{id}").parameters, (Fields{{"id", "{id}"}}));
}

TEST_F(RoutesTest, AllowedListsEachPathsMethods) {
  EXPECT_EQ(routes_.allowed("/a/17"), "DELETE, GET, HEAD, OPTIONS");
  EXPECT_EQ(routes_.allowed("/a"), "GET, HEAD, OPTIONS");
  EXPECT_EQ(routes_.allowed("/b"), "");
  EXPECT_EQ(routes_.find("OPTIONS", "/a/17").route->options.access, Access::open);
}

TEST(ByteBudget, SharesAreBoundedAndReturned) {
  ByteBudget budget(100);
  {
    ByteBudget::Share one(budget);
    ByteBudget::Share two(budget);
    EXPECT_TRUE(one.grow_to(60));
    EXPECT_TRUE(one.grow_to(40)) << "a smaller size is accepted";
    EXPECT_FALSE(two.grow_to(41));
    EXPECT_TRUE(two.grow_to(40));
    EXPECT_FALSE(one.grow_to(61));
  }
  ByteBudget::Share all(budget);
  EXPECT_TRUE(all.grow_to(100));
  EXPECT_FALSE(all.grow_to(101));
}

}  // namespace
}  // namespace papilio::server
