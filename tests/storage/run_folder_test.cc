#include "storage/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/files.h"
#include "storage/network_file.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

using testing::HasSubstr;

using Path = std::filesystem::path;

class RunFolderTest : public ::testing::Test {
 protected:
  std::set<std::string> Names() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory_)) {
      names.insert(entry.path().filename());
    }
    return names;
  }

  std::string Content(const std::string& name) const { return ReadFile(directory_ / name); }

  Vector Parameters(uint64_t seed) const { return experiment_.network()->InitialParameters(seed); }

  /// What the error of opening a run's folder at `path` says; it must be wrong use.
  std::string Refusal(const Path& path) const {
    return ErrorOf([&] { RunFolder(path, experiment_); });
  }

  const TemporaryFolder folder_;
  const Path& directory_ = folder_.path();
  const Experiment experiment_ = SmallExperiment();
};

Evaluation EvaluationOf(int64_t version, bool arrived) {
  return {version, version * 100, version * 10, arrived ? 1.0 : 0.0, {8.5, 1234, 17.25}, {8.5}};
}

TEST_F(RunFolderTest, BeginsWithTheWholeConfigurationInAFolderOfItsOwn) {
  const Path nested = directory_ / "a" / "b";
  const RunFolder folder(nested, experiment_);
  EXPECT_EQ(folder.directory(), nested);
  const Experiment read = Experiment::Load(nested / "config.textproto");
  EXPECT_EQ(read.Text(), experiment_.Text());
  EXPECT_EQ(read.hash(), experiment_.hash());
}

TEST_F(RunFolderTest, HasTheFilesOfARunAndNothingElse) {
  RunFolder folder(directory_, experiment_);
  EXPECT_EQ(Names(), std::set<std::string>{"config.textproto"});
  folder.AddMetrics(EvaluationOf(1, true), {}, 1);
  folder.WriteBest({EvaluationOf(1, true), std::make_shared<const Vector>(Parameters(1))});
  folder.WriteOptimum({0}, {nullptr});
  folder.Finish();
  EXPECT_EQ(Names().count("optimum.json"), 0u);
  const auto plan = std::make_shared<const Plan>(PlanOptimally(experiment_.world(), 0));
  folder.WriteOptimum({0}, {plan});
  folder.Finish();
  EXPECT_TRUE(SameBits(folder.ReadOptimum(std::vector<uint64_t>{0}).front()->flight, plan->flight));
  folder.WriteFinal(Parameters(1), {});
  folder.WriteSummary("{}");
  EXPECT_EQ(Names(), (std::set<std::string>{"best.network", "config.textproto", "events.out.tfevents.fresco",
                                            "final.network", "metrics.csv", "metrics.jsonl", "optimum.json",
                                            "summary.json"}));
}

TEST_F(RunFolderTest, KeepsTheNetworkWithWhichTheTrainingStarts) {
  const auto start = std::make_shared<const Vector>(Parameters(9));
  const Experiment started = experiment_.StartingFrom(start);
  const RunFolder folder(directory_, started);
  EXPECT_EQ(Names(), (std::set<std::string>{"config.textproto", "start.network"}));
  const Experiment read = Experiment::Load(directory_ / "config.textproto");
  EXPECT_EQ(read.start(), nullptr);
  const Experiment whole = RunFolder::WithStart(read, directory_);
  EXPECT_EQ(whole.hash(), started.hash());
  EXPECT_TRUE(whole.FirstParameters() == *start);
  // Without such a start nothing is read, and another network is refused.
  EXPECT_EQ(RunFolder::WithStart(experiment_, directory_).start(), nullptr);
  WriteFileAtomically(directory_ / "start.network", SerializeNetworkFile({experiment_, 0, 0, Parameters(8)}));
  EXPECT_THAT(ErrorOf([&] { RunFolder::WithStart(read, directory_); }),
              testing::AllOf(HasSubstr("start.network"), HasSubstr("expected the network with CRC-32C")));
  std::filesystem::remove(directory_ / "start.network");
  EXPECT_EQ(RunFolder::WithStart(read, directory_).start(), nullptr);
}

TEST_F(RunFolderTest, AddsALineOfMetricsWithEveryEvaluation) {
  RunFolder folder(directory_, experiment_);
  TrainerProgress progress;
  progress.transitions = 780;
  progress.epsilon = 0.16;
  progress.learning_rate = 0.00125;
  progress.loss = 0.0625;
  const std::string header =
      "wall_s,episodes,transitions,updates,version,epsilon,learning_rate,loss,arrived,average_aoi,total_aoi,"
      "sum_aoi\n";
  const std::string first = "1.500,40,780,400,4,0.16,0.00125,0.0625,1,8.5,1234,17.25\n";
  folder.AddMetrics(EvaluationOf(4, true), progress, 1.5);
  folder.Finish();
  EXPECT_EQ(Content("metrics.csv"), header + first);
  progress.transitions = 1560;
  folder.AddMetrics(EvaluationOf(8, false), progress, 61.0625);
  folder.Finish();
  EXPECT_EQ(Content("metrics.csv"),
            header + first + "61.062,80,1560,800,8,0.16,0.00125,0.0625,0,8.5,1234,17.25\n");
}

TEST_F(RunFolderTest, HasTheColumnsOfTheWorld) {
  RunFolder folder(directory_, SmallCartPole());
  folder.AddMetrics({4, 400, 40, 1.0 / 3, {11.25}, {11.25}}, {}, 1.5);
  folder.Finish();
  EXPECT_EQ(Content("metrics.csv"),
            "wall_s,episodes,transitions,updates,version,epsilon,learning_rate,loss,balanced,return\n"
            "1.500,40,0,400,4,0,0,0,0.333333,11.25\n");
}

TEST_F(RunFolderTest, DeliversTheBestNetworkAsANetworkFile) {
  RunFolder folder(directory_, experiment_);
  folder.WriteBest({EvaluationOf(3, true), std::make_shared<const Vector>(Parameters(3))});
  folder.WriteBest({EvaluationOf(9, true), std::make_shared<const Vector>(Parameters(9))});
  folder.Finish();
  const StoredNetwork network = ReadNetworkFile(directory_ / "best.network");
  EXPECT_EQ(network.version, 9);
  EXPECT_EQ(network.updates, 900);
  EXPECT_EQ(network.experiment.hash(), experiment_.hash());
  EXPECT_TRUE(network.parameters == Parameters(9));
}

TEST_F(RunFolderTest, DeliversTheFinalNetworkAsANetworkFile) {
  RunFolder folder(directory_, experiment_);
  TrainerProgress progress;
  progress.current_version = 53;
  progress.updates = 371;
  folder.WriteFinal(Parameters(2), progress);
  const StoredNetwork network = ReadNetworkFile(directory_ / "final.network");
  EXPECT_EQ(network.version, 53);
  EXPECT_EQ(network.updates, 371);
  EXPECT_TRUE(network.parameters == Parameters(2));
}

TEST_F(RunFolderTest, RefusesAFolderWithTheSummaryOfAnotherRunAndLeavesItAsItIs) {
  RunFolder(directory_, SmallExperiment({{"schedule.seed", "8"}})).WriteSummary("{\"seed\": 8}");
  const std::string configuration = Content("config.textproto");
  const std::string refusal = Refusal(directory_);
  EXPECT_THAT(refusal, HasSubstr(directory_.string()));
  EXPECT_EQ(Content("summary.json"), "{\"seed\": 8}\n");
  EXPECT_EQ(Content("config.textproto"), configuration);
}

TEST_F(RunFolderTest, TakesAFolderWithoutASummary) {
  WriteFileAtomically(directory_ / "notes.txt", "mine");
  const RunFolder folder(directory_, experiment_);
  EXPECT_EQ(Content("notes.txt"), "mine");
}

TEST_F(RunFolderTest, RefusesAPlaceWhereNoFolderCanBe) {
  WriteFileAtomically(directory_ / "file", "not a folder");
  EXPECT_THAT(Refusal(directory_ / "file"), HasSubstr("file"));
  EXPECT_THAT(Refusal(directory_ / "file" / "run"), HasSubstr("can't make the folder"));
}

}  // namespace
}  // namespace fresco
