#include "proto/text.h"

#include <gtest/gtest.h>

#include <string>

namespace papilio::proto {
namespace {

TEST(EscapeControls, PrintableTextOfAnyScriptIsUnchanged) {
  for (const std::string text : {"", "a b~", "Körper, 模型, 🦋", "back\\slash"})
    EXPECT_EQ(escape_controls(text), text);
}

TEST(EscapeControls, ControlCharactersAreEscaped) {
  EXPECT_EQ(escape_controls("\x1b[2Jx\r\n\t\x7f"), "\\x1b[2Jx\\x0d\\x0a\\x09\\x7f");
  EXPECT_EQ(escape_controls(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(escape_controls("\xc2\x9b"), "\\x9b");  // a C1 control character in UTF-8
  EXPECT_EQ(escape_controls("a\u202Eb\u2066\u2028"), "a\\u202eb\\u2066\\u2028");
}

TEST(EscapeControls, InvalidUtf8IsEscaped) {
  EXPECT_EQ(escape_controls("\x9b"), "\\x9b");
  EXPECT_EQ(escape_controls("\xc3"), "\\xc3");                             // truncated
  EXPECT_EQ(escape_controls("\xe2\x82z"), "\\xe2\\x82z");                  // truncated by another character
  EXPECT_EQ(escape_controls("\xc0\x9b"), "\\xc0\\x9b");                    // overlong
  EXPECT_EQ(escape_controls("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(escape_controls("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
  EXPECT_EQ(escape_controls("\xff\xfe"), "\\xff\\xfe");
}

}  // namespace
}  // namespace papilio::proto
