#include "core/identifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace fresco {
namespace {

TEST(RunId, IsUpToSixteenHexadecimalDigits) {
  EXPECT_EQ(ParseRunId("1f"), 31);
  EXPECT_EQ(ParseRunId("ffffffffffffffff"), -1);
  for (const std::string text : {"", "0", "0000", "g", "1 ", "-1", "0x1", "10000000000000000"}) {
    EXPECT_THAT([&] { ParseRunId(text); },
                testing::ThrowsMessage<Error>(testing::HasSubstr("\"" + text + "\"")))
        << text;
  }
}

TEST(IdentifierText, AlwaysHasSixteenDigits) {
  EXPECT_EQ(IdentifierText(31), "000000000000001f");
  EXPECT_EQ(IdentifierText(-1), "ffffffffffffffff");
}

}  // namespace
}  // namespace fresco
