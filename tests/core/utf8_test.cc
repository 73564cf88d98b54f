#include "core/utf8.h"

#include <gtest/gtest.h>

namespace fresco {
namespace {

TEST(Utf8, CountsAndCutsCharacters) {
  EXPECT_EQ(CharacterCount("a \u00B1 b"), 5U);
  EXPECT_EQ(CharacterCount("\xFF\xFF"), 2U);
  EXPECT_EQ(FirstCharacters("a\u00B1b", 2), "a\u00B1");
  EXPECT_EQ(FirstCharacters("ab", 9), "ab");
  EXPECT_EQ(FirstCharacters("ab", 0), "");
}

TEST(Utf8, MakesTextsFromOutsidePrintable) {
  EXPECT_EQ(Printable("host \u00E4"), "host \u00E4");
  EXPECT_EQ(Printable("\x1b[2J\n\x7f"), " [2J  ");
  EXPECT_EQ(Printable("\u009B1m"), " 1m");  // a control character of two bytes
  EXPECT_EQ(Printable("a\xFFz"), "a\uFFFDz");
  EXPECT_EQ(Printable(""), "");
}

}  // namespace
}  // namespace fresco
