// Every ready experiment is readable and says what its name promises.
#include <gtest/gtest.h>

#include <filesystem>

#include "msgs/experiment.h"

namespace fresco {
namespace {

const std::filesystem::path kConfigs = std::filesystem::path(FRESCO_SOURCE_DIR) / "configs";

TEST(ConfigFiles, AreAllReadable) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfigs)) {
    EXPECT_NO_THROW(Experiment::Load(entry.path().string())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST(ConfigFiles, PaperIsTheDefaultsButForItsSensorsAndConstants) {
  const Experiment paper = Experiment::Load((kConfigs / "paper.textproto").string());
  const Experiment defaults = Experiment::Parse("", "defaults");
  EXPECT_EQ(paper.agent().DebugString(), defaults.agent().DebugString());
  EXPECT_EQ(paper.schedule().episodes(), defaults.schedule().episodes());
  EXPECT_EQ(paper.schedule().inserts_per_update(), 1);
}

TEST(ConfigFiles, TightEnergyAllowsElevenHovers) {
  const Experiment tight = Experiment::Load((kConfigs / "tight_energy.textproto").string());
  const World world(tight.scenario());
  const double slack_j = world.scenario().initial_energy_j - 69 * world.flying_energy_j();
  EXPECT_EQ(static_cast<int>(slack_j / (world.hovering_energy_j() - world.flying_energy_j())), 11);
}

}  // namespace
}  // namespace fresco
