#include "client/cli/flag_names.h"

#include <gtest/gtest.h>

namespace papilio::client {
namespace {

const std::vector<std::string> names{"levels", "crease_angle", "view.edge_pixels", "to", "help"};

TEST(FlagNames, HyphensUnderscoresAndDotsAreEquivalent) {
  for (const std::string typed :
       {"--view.edge_pixels", "--view.edge-pixels", "--view-edge-pixels", "--view_edge_pixels"}) {
    EXPECT_EQ(known_flag(typed, names), "--view.edge_pixels");
    EXPECT_EQ(known_flag(typed + "=1-_.=", names), "--view.edge_pixels=1-_.=");
  }
  EXPECT_EQ(known_flag("--crease-angle", names), "--crease_angle");
}

TEST(FlagNames, UnknownFlagsAreUnchanged) {
  for (const std::string typed :
       {"--crease", "--levelss", "-o", "-", "--", "", "crease-angle", "--=", "--to=x-y", "---to", "-1,2"})
    EXPECT_EQ(known_flag(typed, names), typed);
}

TEST(FlagNames, MisspeltFlagGetsASuggestion) {
  EXPECT_EQ(unexpected_argument("--crease_angel=30", "papilio refine", names),
            "papilio refine has no flag --crease_angel. Did you mean --crease_angle?");
  EXPECT_EQ(unexpected_argument("--edge-pixels", "papilio refine", names),
            "papilio refine has no flag --edge-pixels. Did you mean --view.edge_pixels?");
  EXPECT_EQ(unexpected_argument("--colour", "papilio refine", names),
            "papilio refine has no flag --colour. papilio refine --help lists what it takes.");
  EXPECT_EQ(unexpected_argument("b.obj", "papilio info", names),
            "\"b.obj\" is not expected after papilio info. papilio info --help lists what it takes.");
}

}  // namespace
}  // namespace papilio::client
