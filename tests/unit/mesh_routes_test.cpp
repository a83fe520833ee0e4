#include "server/routes/mesh_routes.h"

#include <gtest/gtest.h>

#include <set>

#include "proto/parameters.h"
#include "server/sha256.h"

namespace papilio::server {
namespace {

// FIPS 180-2, appendix B.
TEST(Sha256, HashesEqualTheTestVectors) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_TRUE(is_sha256(sha256("x")));
  EXPECT_FALSE(is_sha256(sha256("x") + "0"));
  EXPECT_FALSE(is_sha256(std::string(64, 'G')));
}

std::string tag(const proto::QueryFields& query, const std::string& id = "id", const std::string& type = "type") {
  return entity_tag(id, proto::parse_query(query), type);
}

TEST(EntityTag, EqualParametersHaveEqualTags) {
  EXPECT_EQ(tag({}), tag({{"levels", "2"}, {"w", "0"}}));
  EXPECT_EQ(tag({{"levels", "3"}, {"w", "0.05"}}), tag({{"w", "5e-2"}, {"levels", "3"}}));
  EXPECT_EQ(tag({{"view.fov_y", "45"}}), tag({{"view.up", "0,1,0"}})) << "both are the default view";
}

TEST(EntityTag, TagChangesWithEveryParameter) {
  std::set<std::string> tags{tag({}), tag({}, "other"), tag({}, "id", "other")};
  size_t expected = 3;
  for (const proto::ParameterInfo& info : proto::parameter_table()) {
    std::string value = "0.1";
    if (info.type == proto::ParameterType::boolean) value = "true";
    if (info.type == proto::ParameterType::choice) value = info.choices[1];
    if (info.type == proto::ParameterType::integer) value = info.min <= 0 && info.max >= 5 ? "5" : "9";
    if (info.type == proto::ParameterType::integer && info.max < 5) value = "0";
    if (info.type == proto::ParameterType::numbers) {
      value = info.min > 0 ? "7" : "0.5";
      for (size_t i = 1; i < info.least; ++i) value += info.min > 0 ? ",9" : ",0.25";
    }
    proto::QueryFields query{{std::string(info.name), value}};
    if (info.name == "simplify_hidden") query.emplace_back("view.up", "0,1,0.5");
    tags.insert(tag(query));
    EXPECT_EQ(tags.size(), ++expected) << info.name << "=" << value;
  }
}

TEST(NoneMatch, ListsOfTagsAndTheWildcardMatch) {
  EXPECT_TRUE(none_match_has("\"a\"", "\"a\""));
  EXPECT_TRUE(none_match_has("\"b\", W/\"a\" ", "\"a\""));
  EXPECT_TRUE(none_match_has("*", "\"a\""));
  for (const char* other : {"", "\"b\"", "a", "\"a", "\"b\",", ",,", "W/a"})
    EXPECT_FALSE(none_match_has(other, "\"a\"")) << other;
}

}  // namespace
}  // namespace papilio::server
