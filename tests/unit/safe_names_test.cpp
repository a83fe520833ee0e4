#include "client/lib/safe_names.h"

#include <gtest/gtest.h>

namespace papilio::client {
namespace {

TEST(SafeNames, FileNamesStayInTheirFolderAndOnTheirLine) {
  EXPECT_EQ(safe_file_name("wood-2_a b.old"), "wood-2_a_b.old");
  EXPECT_EQ(safe_file_name("../../etc/passwd"), "_._.._etc_passwd");
  EXPECT_EQ(safe_file_name("a\\b:c\n#\"d"), "a_b_c___d");
  EXPECT_EQ(safe_file_name("-s"), "_s");
  EXPECT_EQ(safe_file_name(" a "), "_a_");
  EXPECT_EQ(safe_file_name("."), "_");
  EXPECT_EQ(safe_file_name(""), "");
  EXPECT_EQ(safe_file_name("\xc3\xa4"), "\xc3\xa4");
}

TEST(SafeNames, LongNamesAreCutBetweenCharacters) {
  EXPECT_EQ(safe_file_name(std::string(300, 'a')), std::string(100, 'a'));
  std::string wide;
  for (int i = 0; i < 60; ++i) wide += "\xe2\x82\xac";
  EXPECT_EQ(safe_file_name(wide), wide.substr(0, 99));
}

TEST(SafeNames, MaterialNamesFitOnALine) {
  EXPECT_EQ(safe_material_name("Hard Shiny #2"), "Hard Shiny #2");
  EXPECT_EQ(safe_material_name(" a\nf 1 2 3\t\\"), "_a_f 1 2 3__");
  EXPECT_EQ(safe_material_name(""), "");
}

TEST(SafeNames, TakenNamesAreNumbered) {
  UniqueNames files(UniqueNames::Kind::file);
  EXPECT_EQ(files.add("a", ".png"), "a.png");
  EXPECT_EQ(files.add("A", ".png"), "A_2.png");
  EXPECT_EQ(files.add("a_2", ".png"), "a_2_2.png");
  EXPECT_EQ(files.add("a", ".png"), "a_3.png");
  EXPECT_EQ(files.add("a", ".jpg"), "a.jpg");
  UniqueNames materials(UniqueNames::Kind::material);
  EXPECT_EQ(materials.add("a"), "a");
  EXPECT_EQ(materials.add("A"), "A");
  EXPECT_EQ(materials.add("a"), "a_2");
}

}  // namespace
}  // namespace papilio::client
