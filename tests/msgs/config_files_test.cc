// The configurations that Fresco comes with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "msgs/experiment.h"
#include "tests/msgs/usage_error.h"

namespace fresco {
namespace {

using testing::HasSubstr;

const std::filesystem::path kConfigs = std::filesystem::path(FRESCO_SOURCE_DIR) / "configs";

std::vector<std::filesystem::path> ConfigFiles() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kConfigs)) {
    if (entry.path().extension() == ".textproto") {
      files.push_back(entry.path());
    }
  }
  return files;
}

TEST(ConfigFiles, AllLoad) {
  const std::vector<std::filesystem::path> files = ConfigFiles();
  EXPECT_FALSE(files.empty());
  for (const std::filesystem::path& file : files) {
    EXPECT_NO_THROW({
      const Experiment experiment = Experiment::Load(file.string());
      EXPECT_EQ(Experiment::Parse(experiment.Text(), "its text").hash(), experiment.hash());
    }) << file;
  }
}

TEST(ConfigFiles, TakeSettings) {
  const Experiment experiment =
      Experiment::Load((kConfigs / "quick.textproto").string(), {{"schedule.seed", "42"}});
  EXPECT_EQ(experiment.schedule().seed(), 42u);
}

TEST(ConfigFiles, AreNamedWhereTheyCannotBeRead) {
  EXPECT_THAT(UsageErrorOf([] { Experiment::Load((kConfigs / "missing.textproto").string()); }),
              HasSubstr("missing.textproto"));
  EXPECT_THAT(UsageErrorOf([] { Experiment::Load(kConfigs.string()); }), HasSubstr(kConfigs.string()));
}

}  // namespace
}  // namespace fresco
