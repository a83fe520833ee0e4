#include "proto/name_suggestion.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace papilio::proto {
namespace {

constexpr std::array<std::string_view, 6> names{"levels", "tolerance", "w", "view.eye", "view.edge_pixels", "view.up"};

TEST(NameSuggestion, IsTheNearestNameWithinAThirdOfItsLength) {
  EXPECT_EQ(suggest_name("tolerence", names), "tolerance");   // substitution
  EXPECT_EQ(suggest_name("toleranc", names), "tolerance");    // deletion
  EXPECT_EQ(suggest_name("ttolerance", names), "tolerance");  // insertion
  EXPECT_EQ(suggest_name("tolerancet", names), "tolerance");
  EXPECT_EQ(suggest_name("elvesl", names), "levels");  // two swaps
  EXPECT_EQ(suggest_name("view.edge-pixels", names), "view.edge_pixels");
  EXPECT_EQ(suggest_name("viewEye", names), "view.eye");
}

TEST(NameSuggestion, PartAfterTheDotMatchesTheName) {
  EXPECT_EQ(suggest_name("eye", names), "view.eye");
  EXPECT_EQ(suggest_name("up", names), "view.up");
  EXPECT_EQ(suggest_name("edge_pixel", names), "view.edge_pixels");
}

TEST(NameSuggestion, DistantNamesHaveNoSuggestion) {
  for (const std::string_view typed : {"", "x", "colour", "lvs", "tolerate_more"})
    EXPECT_FALSE(suggest_name(typed, names)) << typed;
  EXPECT_FALSE(suggest_name(std::string(1 << 20, 't'), names));
  EXPECT_FALSE(suggest_name("levels", {}));
}

}  // namespace
}  // namespace papilio::proto
