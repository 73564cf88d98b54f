#include "msgs/ready_experiments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/files.h"
#include "msgs/experiment.h"
#include "tests/msgs/uav_world_of.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsSupersetOf;

const std::filesystem::path kReadyFolder = std::filesystem::path(FRESCO_SOURCE_DIR) / "configs";

/// The names as errors and help list them.
std::string Listed() {
  std::string listed;
  for (const std::string& name : ReadyExperiments()) {
    listed += (listed.empty() ? "" : ", ") + name;
  }
  return listed;
}

/// In a folder without any file, as somebody is who uses an installation.
class ReadyExperimentsTest : public ::testing::Test {
 protected:
  ReadyExperimentsTest() { std::filesystem::current_path(folder_.path()); }
  ~ReadyExperimentsTest() override { std::filesystem::current_path(before_); }

  const std::filesystem::path before_ = std::filesystem::current_path();
  const TemporaryFolder folder_;
};

TEST_F(ReadyExperimentsTest, AreThoseOfTheSourceTree) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kReadyFolder)) {
    if (entry.path().extension() == ".textproto") {  // not a map
      names.insert(entry.path().stem());
    }
  }
  EXPECT_THAT(ReadyExperiments(), ElementsAreArray(names));
  EXPECT_THAT(ReadyExperiments(), IsSupersetOf({"ci", "paper", "quick", "tight_energy"}));
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

TEST_F(ReadyExperimentsTest, DoNotStandBackForAFolder) {
  std::filesystem::create_directory("paper");
  EXPECT_EQ(ReadFile(ExperimentPath("paper")), ReadFile(kReadyFolder / "paper.textproto"));
  std::filesystem::create_directory("other");
  EXPECT_EQ(ExperimentPath("other"), "other") << "whoever reads it says that it is a folder";
}

TEST_F(ReadyExperimentsTest, AreListedWhereThereIsNoSuchFile) {
  EXPECT_THAT(ErrorOf([] { ExperimentPath("quik.textproto"); }),
              AllOf(HasSubstr("--config"), HasSubstr("\"quik.textproto\""), HasSubstr(Listed()),
                    HasSubstr("did you mean quick?")));
  for (const std::string config : {"/nowhere/quick.textproto", "", "other/quick.textproto", "../quick"}) {
    EXPECT_THAT(ErrorOf([&] { ExperimentPath(config); }), HasSubstr("\"" + config + "\"")) << config;
  }
}

TEST_F(ReadyExperimentsTest, StandInTheHelpOfTheOption) {
  EXPECT_THAT(ConfigHelp(), AllOf(HasSubstr(Listed()), HasSubstr("default: quick")));
}

TEST(ConfigFiles, AreAllReadable) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kReadyFolder)) {
    if (entry.path().extension() == ".textproto") {  // not a map
      EXPECT_NO_THROW(Experiment::Load(entry.path().string())) << entry.path();
      ++count;
    }
  }
  EXPECT_GE(count, 4);
}

TEST(ConfigFiles, PaperIsTheDefaultsButForItsSensorsAndConstants) {
  const Experiment paper = Experiment::Load((kReadyFolder / "paper.textproto").string());
  const Experiment defaults = Experiment::Parse("", "defaults");
  EXPECT_EQ(paper.agent().DebugString(), defaults.agent().DebugString());
  EXPECT_EQ(paper.schedule().episodes(), defaults.schedule().episodes());
  EXPECT_EQ(paper.schedule().inserts_per_update(), 1);
}

TEST(ConfigFiles, TightEnergyAllowsElevenHovers) {
  const Experiment tight = Experiment::Load((kReadyFolder / "tight_energy.textproto").string());
  const UavWorld& world = UavWorldOf(tight);
  const double slack_j = world.scenario().initial_energy_j - 69 * world.flying_energy_j();
  EXPECT_EQ(static_cast<int>(slack_j / (world.hovering_energy_j() - world.flying_energy_j())), 11);
}

}  // namespace
}  // namespace fresco
