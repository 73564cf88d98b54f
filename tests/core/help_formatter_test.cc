#include "core/help_formatter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/command_line.h"

namespace fresco {
namespace {

using testing::HasSubstr;
using testing::Not;

class HelpFormatterTest : public ::testing::Test {
 protected:
  HelpFormatterTest() { app_.formatter(std::make_shared<HelpFormatter>()); }

  CLI::App app_{"Flies.", "fly"};
  std::string text_ = "json";
  int number_ = 3;
  bool flag_ = false;
};

TEST_F(HelpFormatterTest, ShowsWhatAnOptionTakes) {
  app_.add_option("--format", text_, "How it is printed")->check(OneOf({"text", "json"}));
  app_.add_option("--rate", number_, "Slots a second")->check(CLI::Range(1, 9))->capture_default_str();
  app_.add_option("--lcm-url", text_, "Where")->type_name("URL")->required();
  app_.add_flag("--loop", flag_, "Again and again");
  const std::string help = app_.help();
  EXPECT_THAT(help, HasSubstr("\n  --format {text,json}      How it is printed\n"));
  EXPECT_THAT(help, HasSubstr("\n  --rate N                  Slots a second; default: 3\n"));
  EXPECT_THAT(help, HasSubstr("\n  --lcm-url URL             Where (required)\n"));
  EXPECT_THAT(help, HasSubstr("\n  --loop                    Again and again\n"));
}

TEST_F(HelpFormatterTest, SaysWhatGoesTogether) {
  CLI::Option* record = app_.add_flag("--record", flag_, "Record");
  CLI::Option* seed = app_.add_option("--seed", number_, "Seed");
  app_.add_option("--split", number_, "Split")->needs(record);
  app_.add_option("--resume", text_, "Go on")->type_name("FOLDER")->excludes(seed);
  const std::string help = app_.help();
  EXPECT_THAT(help, HasSubstr("Split; only with --record\n"));
  EXPECT_THAT(help, HasSubstr("Go on; not with --seed\n"));
  EXPECT_THAT(help, HasSubstr("Seed; not with --resume\n"));
}

TEST_F(HelpFormatterTest, WrapsAndAligns) {
  std::string words;
  for (int i = 0; i < 40; ++i) {
    words += "word ";
  }
  app_.add_option("--an-option-with-a-long-name", number_, words);
  app_.add_subcommand("below", words);
  app_.footer(HelpExamples({"fly --rate 2", "fly --loop"}));
  const std::string help = app_.help();
  EXPECT_THAT(help, HasSubstr("\n  --an-option-with-a-long-name N\n                            word word"));
  EXPECT_THAT(help, HasSubstr("\n  below                     word word"));
  EXPECT_THAT(help, HasSubstr("\nExamples:\n  fly --rate 2\n  fly --loop\n"));
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 100U) << line;
    EXPECT_THAT(line, Not(testing::EndsWith(" "))) << line;
  }
}

}  // namespace
}  // namespace fresco
