#include "core/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_of.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A program with commands, one of them with commands of its own.
struct Commands {
  Commands() {
    app.require_subcommand(1);
    CLI::App* train = app.add_subcommand("train", "");
    train->add_option("--config", config, "");
    train->add_option("--format", format, "")->check(OneOf({"text", "json"}));
    CLI::App* log = app.add_subcommand("log", "");
    log->require_subcommand(1);
    log->add_subcommand("record", "")->add_option("--out", config, "")->required();
    log->add_subcommand("cat", "")->add_option("LOG", logs, "")->required();
  }

  bool Parse(const std::vector<const char*>& arguments) {
    std::vector<const char*> all(arguments.size() + 1, "/anywhere/fresco");
    std::copy(arguments.begin(), arguments.end(), all.begin() + 1);
    return ParseCommandLine(app, static_cast<int>(all.size()), all.data());
  }

  CLI::App app{"", "fresco"};
  std::string config;
  std::string format;
  std::vector<std::string> logs;
};

std::string WrongUse(const std::vector<const char*>& arguments) {
  return ErrorOf([&] { Commands().Parse(arguments); });
}

TEST(CommandLine, IsParsed) {
  Commands program;
  EXPECT_TRUE(program.Parse({"train", "--config", "a", "--format", "json"}));
  EXPECT_EQ(program.config, "a");
  EXPECT_EQ(program.format, "json");
  Commands log;
  EXPECT_TRUE(log.Parse({"log", "cat", "a", "b"}));
  EXPECT_EQ(log.logs, (std::vector<std::string>{"a", "b"}));
}

TEST(CommandLine, LeavesNothingToDoAfterHelp) {
  testing::internal::CaptureStdout();
  EXPECT_FALSE(Commands().Parse({"log", "record", "--help"}));
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("--out"));
}

TEST(CommandLine, NamesTheNearestCommand) {
  EXPECT_THAT(WrongUse({"trian"}),
              AllOf(StartsWith("fresco: there is no command \"trian\""), HasSubstr("train, log"),
                    HasSubstr("; did you mean train?\nsee fresco --help")));
  EXPECT_THAT(WrongUse({"trian", "--config", "a"}), HasSubstr("did you mean train?"));
  EXPECT_THAT(WrongUse({"log", "recrod", "--out", "a"}),
              AllOf(StartsWith("fresco log: there is no command \"recrod\""),
                    HasSubstr("did you mean record?"), HasSubstr("see fresco log --help")));
  EXPECT_THAT(WrongUse({"record"}), HasSubstr("did you mean log record?"));
  EXPECT_THAT(WrongUse({"frobnicate"}), AllOf(HasSubstr("frobnicate"), Not(HasSubstr("did you mean"))));
}

TEST(CommandLine, NamesTheNearestOptionOfTheCommand) {
  EXPECT_THAT(WrongUse({"train", "--confg", "a"}),
              StartsWith("fresco train: there is no option --confg; did you mean --config?"));
  EXPECT_THAT(WrongUse({"train", "--confg=a"}), HasSubstr("no option --confg; did you mean --config?"));
  EXPECT_THAT(WrongUse({"train", "-config", "a"}), HasSubstr("did you mean --config?"));
  EXPECT_THAT(WrongUse({"log", "record", "--otu", "a"}),  // and not that --out is missing
              StartsWith("fresco log record: there is no option --otu; did you mean --out?"));
}

TEST(CommandLine, NamesTheNearestValue) {
  EXPECT_THAT(WrongUse({"train", "--format", "jsn"}),
              AllOf(StartsWith("fresco train: --format: "), HasSubstr("expected text or json, found \"jsn\""),
                    HasSubstr("did you mean json?")));
}

TEST(CommandLine, SaysWhatIsMissingOrTooMuch) {
  EXPECT_THAT(WrongUse({}), StartsWith("fresco: expected a command: train, log\n"));
  EXPECT_THAT(WrongUse({"log"}), StartsWith("fresco log: expected a command: record, cat\n"));
  EXPECT_THAT(WrongUse({"log", "record"}), AllOf(StartsWith("fresco log record: "), HasSubstr("--out")));
  EXPECT_THAT(WrongUse({"train", "now"}), HasSubstr("fresco train: expected options only, found \"now\""));
}

TEST(Program, EndsWithTheStatusOfWhatItsFunctionReturnsOrThrows) {
  const auto status = [](const std::string& name, const std::function<int()>& run) {
    const char* const argv[] = {name.c_str()};
    return Program(name, "", LogStyle::kPlain, {"unknown"}).Run(1, argv, run);
  };
  EXPECT_EQ(status("returns", [] { return 7; }), 7);
  EXPECT_EQ(status("is-used-wrongly", []() -> int { throw UsageError("x"); }), 2);
  EXPECT_EQ(status("fails", []() -> int { throw Failure("x"); }), 1);
  EXPECT_EQ(status("has-a-defect", []() -> int { throw std::runtime_error("x"); }), 1);
}

}  // namespace
}  // namespace fresco
