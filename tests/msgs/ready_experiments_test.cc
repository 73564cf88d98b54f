#include "msgs/ready_experiments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>

#include "core/files.h"
#include "tests/msgs/usage_error.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::filesystem::path kReadyFolder = std::filesystem::path(FRESCO_SOURCE_DIR) / "configs";

/// In a folder without any file, as somebody is who uses an installation.
class ReadyExperimentsTest : public ::testing::Test {
 protected:
  ReadyExperimentsTest()
      : before_(std::filesystem::current_path()),
        directory_(std::filesystem::temp_directory_path() / ("fresco-ready-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(directory_);
    std::filesystem::current_path(directory_);
  }
  ~ReadyExperimentsTest() override {
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(directory_);
  }

  std::filesystem::path before_;
  std::filesystem::path directory_;
};

TEST_F(ReadyExperimentsTest, AreThoseOfTheSourceTree) {
  EXPECT_THAT(ReadyExperiments(), ElementsAre("ci", "paper", "quick", "tight_energy"));
}

TEST_F(ReadyExperimentsTest, AreFoundByNameFromEveryFolder) {
  const std::string text = ReadFile(kReadyFolder / "paper.textproto");
  for (const std::string config : {"paper", "paper.textproto", "configs/paper.textproto", "configs/paper"}) {
    EXPECT_EQ(ReadFile(ExperimentPath(config)), text) << config;
  }
}

TEST_F(ReadyExperimentsTest, StandBackForAPathThatExists) {
  WriteFileAtomically("quick", "");
  EXPECT_EQ(ExperimentPath("quick"), "quick");
  std::filesystem::create_directory("configs");
  WriteFileAtomically("configs/paper.textproto", "");
  EXPECT_EQ(ExperimentPath("configs/paper.textproto"), "configs/paper.textproto");
}

TEST_F(ReadyExperimentsTest, AreListedWhereThereIsNoSuchFile) {
  EXPECT_THAT(UsageErrorOf([] { ExperimentPath("quik.textproto"); }),
              AllOf(HasSubstr("--config"), HasSubstr("\"quik.textproto\""),
                    HasSubstr("ci, paper, quick, tight_energy"), HasSubstr("did you mean quick?")));
  for (const std::string config : {"/nowhere/quick.textproto", "", "other/quick.textproto", "../quick"}) {
    EXPECT_THAT(UsageErrorOf([&] { ExperimentPath(config); }), HasSubstr("\"" + config + "\"")) << config;
  }
}

TEST_F(ReadyExperimentsTest, StandInTheHelpOfTheOption) {
  EXPECT_THAT(ConfigHelp(), AllOf(HasSubstr("ci, paper, quick, tight_energy"), HasSubstr("default: quick")));
}

}  // namespace
}  // namespace fresco
