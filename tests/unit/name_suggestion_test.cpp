#include "proto/name_suggestion.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace papilio::proto {
namespace {

constexpr std::array<std::string_view, 6> known_names{"levels",   "tolerance",        "w",
                                                      "view.eye", "view.edge_pixels", "view.up"};

TEST(NameSuggestion, NearestNameWithinAThirdOfTheLengthIsSuggested) {
  EXPECT_EQ(suggest_name("tolerence", known_names), "tolerance");   // substitution
  EXPECT_EQ(suggest_name("toleranc", known_names), "tolerance");    // deletion
  EXPECT_EQ(suggest_name("ttolerance", known_names), "tolerance");  // insertion
  EXPECT_EQ(suggest_name("tolerancet", known_names), "tolerance");
  EXPECT_EQ(suggest_name("elvesl", known_names), "levels");  // two swaps
  EXPECT_EQ(suggest_name("view.edge-pixels", known_names), "view.edge_pixels");
  EXPECT_EQ(suggest_name("viewEye", known_names), "view.eye");
}

TEST(NameSuggestion, PartAfterTheDotMatchesTheName) {
  EXPECT_EQ(suggest_name("eye", known_names), "view.eye");
  EXPECT_EQ(suggest_name("up", known_names), "view.up");
  EXPECT_EQ(suggest_name("edge_pixel", known_names), "view.edge_pixels");
}

TEST(NameSuggestion, DistantNamesHaveNoSuggestion) {
  for (const std::string_view typed : {"", "x", "colour", "lvs", "tolerate_more"})
    EXPECT_FALSE(suggest_name(typed, known_names)) << typed;
  EXPECT_FALSE(suggest_name(std::string(1 << 20, 't'), known_names));
  EXPECT_FALSE(suggest_name("levels", {}));
}

}  // namespace
}  // namespace papilio::proto
