#include "core/csv.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/files.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

TEST(Csv, QuotesOnlyWhatHasToBeQuoted) {
  // RFC 4180, section 2, rules 5 to 7.
  EXPECT_EQ(CsvText({"policy", "note"}, {{"DQN", "plain text"}, {"a,b", "say \"no\""}, {"two\nlines", ""}}),
            "policy,note\nDQN,plain text\n\"a,b\",\"say \"\"no\"\"\"\n\"two\nlines\",\n");
}

TEST(Csv, KeepsEveryBitOfANumber) {
  const double awkward[] = {0.1 + 0.2, 1.0 / 3, 13.280952380952381, -2.5e-300, 6.02214076e23};
  for (const double value : awkward) {
    const std::string text = CsvText({"value"}, {{value}});
    EXPECT_EQ(std::strtod(text.c_str() + sizeof("value"), nullptr), value) << text;
  }
  EXPECT_EQ(CsvText({"count", "value"}, {{int64_t{9007199254740993}, 0.5}}),
            "count,value\n9007199254740993,0.5\n");
}

TEST(Csv, WritesTheFile) {
  const TemporaryFolder folder;
  WriteCsv(folder.path() / "table.csv", {"radius"}, {{1}, {2.5}});
  EXPECT_EQ(ReadFile(folder.path() / "table.csv"), "radius\n1\n2.5\n");
}

TEST(CsvDeathTest, RefusesARowOfAnotherLength) {
  EXPECT_DEATH(CsvText({"a", "b"}, {{1}}), "header");
}

}  // namespace
}  // namespace fresco
