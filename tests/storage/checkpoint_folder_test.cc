// What a killed learner finds in its folder: whole, torn, foreign and newer checkpoints.
#include "storage/checkpoint_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <map>

#include "core/files.h"
#include "nn/mlp.h"
#include "storage/run_folder.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

using testing::HasSubstr;

using Path = std::filesystem::path;

class ResumptionTest : public ::testing::Test {
 protected:
  ResumptionTest() {
    spdlog::set_level(spdlog::level::off);
    RunFolder folder(directory_, run_.experiment);
    checkpoints_.Make();
  }

  /// The bytes of a checkpoint after one more episode.
  std::string NextCheckpoint() { return NextCheckpoint(run_.experiment, ArithmeticFingerprint()); }
  /// Of another configuration or program.
  std::string NextCheckpoint(const Experiment& experiment, uint32_t fingerprint) {
    run_.Commit(run_.Fly(run_.next()));
    return SerializeCheckpoint({experiment, fingerprint, 77, run_.trainer.Save()});
  }
  Path Write(const std::string& content) const {
    const Path path = checkpoints_.PathFor(static_cast<int64_t>(run_.episodes.size()));
    WriteFileAtomically(path, content);
    return path;
  }
  /// Goes on as a learner does; returns the orders committed at the checkpoint.
  int64_t Taken() const {
    const Resumption resumption = ReadResumption(directory_, {});
    SetAside(resumption.unusable);
    return resumption.checkpoint->training.progress.committed_orders;
  }
  std::string Refusal(const Settings& settings = {}) const {
    return ErrorOf([&] { ReadResumption(directory_, settings); });
  }

  RecordedRun run_;
  const TemporaryFolder folder_;
  const Path& directory_ = folder_.path();
  CheckpointFolder checkpoints_{directory_};
};

TEST_F(ResumptionTest, TakesTheLatestCheckpoint) {
  for (int i = 0; i < 3; ++i) {
    Write(NextCheckpoint());
  }
  EXPECT_EQ(Taken(), 3);
  EXPECT_EQ(ReadResumption(directory_, {}).checkpoint->run_id, 77);
}

/// In a world with chance, in which an evaluation has several episodes and a checkpoint may fall between
/// them.
TEST(CartPoleCheckpoint, GoesOnWithTheSameBitsFromAnyPlace) {
  const FinishedRun whole(SmallCartPole());
  const auto orders = whole.episodes.size();
  int within_evaluations = 0;
  int delivering = 0;
  int truncated = 0;
  for (size_t stop = 1; stop < orders; stop += 3) {
    RecordedRun run(SmallCartPole());
    while (run.episodes.size() < stop) {
      run.Commit(run.Fly(run.next()));
    }
    const Checkpoint read = ParseCheckpoint(
        SerializeCheckpoint({run.experiment, ArithmeticFingerprint(), 77, run.trainer.Save()}), "a test");
    const TrainingState& state = read.training;
    within_evaluations += state.partial_evaluation.episodes > 0 ? 1 : 0;
    delivering += state.progress.delivering ? 1 : 0;
    for (const auto& episode : state.replay) {
      truncated += episode->ending == Ending::kTruncated ? 1 : 0;
    }
    std::map<int64_t, Order> orders_again;
    std::map<NetworkVersion, std::shared_ptr<const Vector>> versions;
    TrainerOutput output;
    output.order = [&](const Order& order) { orders_again[order.index] = order; };
    output.version = [&](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
      versions[version] = std::move(parameters);
    };
    output.evaluation = [](const Evaluation&) {};
    Trainer resumed(read.experiment, output);
    resumed.Resume(state);
    while (!resumed.finished()) {
      const Order order = orders_again.at(resumed.progress().committed_orders);
      resumed.Commit(
          order, FlyOrder(read.experiment, order, versions.at({NetworkKind::kCurrent, order.current_version}),
                          versions.at({NetworkKind::kTarget, order.target_version}))
                     .episode);
    }
    EXPECT_TRUE(resumed.current() == whole.trainer.current()) << stop;
    ASSERT_TRUE(resumed.delivered()) << stop;
    EXPECT_EQ(resumed.delivered()->figures, whole.trainer.delivered()->figures) << stop;
    EXPECT_EQ(resumed.delivered()->version, whole.trainer.delivered()->version) << stop;
  }
  EXPECT_GT(within_evaluations, 0);
  EXPECT_GT(delivering, 0);
  EXPECT_GT(truncated, 0);
}

TEST_F(ResumptionTest, BeginsAtTheBeginningWhereThereIsNoCheckpoint) {
  EXPECT_FALSE(ReadResumption(directory_, {}).checkpoint.has_value());
  std::filesystem::remove_all(directory_ / "checkpoints");
  EXPECT_FALSE(ReadResumption(directory_, {}).checkpoint.has_value());
}

TEST_F(ResumptionTest, TakesTheOneBeforeWhereTheLatestIsTornDamagedForeignOrNewer) {
  Write(NextCheckpoint());
  const std::string whole = NextCheckpoint();
  std::string damaged = whole;
  damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] ^ 1);
  std::string newer = whole;
  newer.replace(newer.find("fresco-checkpoint-5"), 19, "fresco-checkpoint-9");
  for (const std::string& content : {std::string(), whole.substr(0, 1), whole.substr(0, 40),
                                     whole.substr(0, whole.size() / 2), whole.substr(0, whole.size() - 1),
                                     damaged, newer, std::string("P5 640 480"), std::string(9999, '\n')}) {
    Write(content);
    EXPECT_EQ(Taken(), 1) << content.size() << " bytes";
  }
  Write(whole);
  EXPECT_EQ(Taken(), 2);
}

TEST_F(ResumptionTest, TakesTheOneBeforeWhereTheLatestIsOfAnotherRunOrProgram) {
  Write(NextCheckpoint());
  const Experiment other =
      Experiment::Load((directory_ / "config.textproto").string(), {{"schedule.episodes", "61"}});
  Write(NextCheckpoint(other, ArithmeticFingerprint()));
  Write(NextCheckpoint(run_.experiment, ArithmeticFingerprint() ^ 1));
  EXPECT_EQ(Taken(), 1);
}

TEST_F(ResumptionTest, KeepsWhatItGoesOnFromRatherThanLaterOnesThatAreUnusable) {
  const Path taken = Write(NextCheckpoint());
  const std::string torn = NextCheckpoint().substr(0, 1000);
  const Path path = Write(torn);
  EXPECT_EQ(Taken(), 1);
  checkpoints_.Prune(1);
  EXPECT_EQ(checkpoints_.Latest(), std::vector<Path>{taken});
  EXPECT_EQ(ReadFile(path.string() + ".unusable"), torn);
}

TEST_F(ResumptionTest, SetsAsideWhatItCantReadToo) {
  const Path taken = Write(NextCheckpoint());
  std::filesystem::create_directory(checkpoints_.PathFor(2));
  EXPECT_EQ(Taken(), 1);
  EXPECT_EQ(checkpoints_.Latest(), std::vector<Path>{taken});
}

TEST_F(ResumptionTest, ChangesNothingInTheFolderUntilTheRunGoesOn) {
  Write(NextCheckpoint());
  const Path torn = Write(NextCheckpoint().substr(0, 1000));
  const Resumption resumption = ReadResumption(directory_, {});
  ASSERT_EQ(resumption.unusable.size(), 1u);
  EXPECT_EQ(resumption.unusable.front().path, torn);
  EXPECT_THAT(resumption.unusable.front().problem, HasSubstr("cut short"));
  EXPECT_TRUE(std::filesystem::exists(torn));
}

TEST_F(ResumptionTest, NamesTheNewestRunInAFolderOfRuns) {
  const Path runs = directory_ / "runs";
  for (const std::string name : {"early", "late"}) {
    RunFolder folder(runs / name, run_.experiment);
  }
  const auto late = std::filesystem::last_write_time(runs / "late" / "config.textproto");
  std::filesystem::last_write_time(runs / "early" / "config.textproto", late - std::chrono::seconds(1));
  std::filesystem::create_directory(runs / "no-run");
  EXPECT_EQ(NewestRunHint(runs, "config.textproto"), "; the newest run in it is " + (runs / "late").string());
  EXPECT_EQ(NewestRunHint(runs, "best.network"), "");
  EXPECT_EQ(NewestRunHint(runs / "nowhere", "config.textproto"), "");
}

TEST_F(ResumptionTest, LeavesFilesOfOtherNamesAlone) {
  const Path path = Write(NextCheckpoint());
  const Path backup = checkpoints_.PathFor(0).parent_path() / "backup.checkpoint";
  WriteFileAtomically(backup, NextCheckpoint());
  EXPECT_EQ(Taken(), 1);
  checkpoints_.Prune(1);
  EXPECT_TRUE(std::filesystem::exists(backup));
  EXPECT_EQ(checkpoints_.Latest(), std::vector<Path>{path});
}

TEST_F(ResumptionTest, NamesWhatIsWrongWithEachWhereNoneIsWhole) {
  const std::string whole = NextCheckpoint();
  Write(whole.substr(0, 1000));
  std::string newer = NextCheckpoint();
  newer.replace(newer.find("fresco-checkpoint-5"), 19, "fresco-checkpoint-9");
  const Path path = Write(newer);
  const std::string refusal = Refusal();
  for (const std::string& part : {std::string("cut short, at 1000 bytes"), std::string("fresco-checkpoint-9"),
                                  path.string(), std::string("2 checkpoints")}) {
    EXPECT_THAT(refusal, HasSubstr(part));
  }
}

TEST_F(ResumptionTest, LetsOnlyTheRunSectionChange) {
  Write(NextCheckpoint());
  EXPECT_EQ(ReadResumption(directory_, {{"run.actors", "7"}}).experiment.run().actors(), 7);
  EXPECT_THAT(Refusal({{"schedule.episodes", "61"}}), HasSubstr("only fields of run"));
}

TEST_F(ResumptionTest, RefusesACheckpointOfAnotherArithmetic) {
  Write(NextCheckpoint(run_.experiment, ArithmeticFingerprint() ^ 1));
  EXPECT_THAT(Refusal(), HasSubstr("same release"));
}

TEST_F(ResumptionTest, RefusesAFolderWithoutARunAndACompleteRun) {
  WriteFileAtomically(directory_ / "summary.json", R"({"completed": false})");
  EXPECT_NO_THROW(ReadResumption(directory_, {}));
  WriteFileAtomically(directory_ / "summary.json", R"({"completed": true})");
  EXPECT_THAT(Refusal(), HasSubstr("complete"));
  WriteFileAtomically(directory_ / "summary.json", R"({"completed": true, "optimum_search": "limit"})");
  EXPECT_THAT(Refusal(), HasSubstr("complete"));
  std::filesystem::remove(directory_ / "config.textproto");
  EXPECT_THAT(Refusal(), HasSubstr("config.textproto"));
}

TEST_F(ResumptionTest, LetsAStoppedSearchForTheOptimumGoOn) {
  WriteFileAtomically(directory_ / "summary.json", R"({"completed": true, "optimum_search": "stopped"})");
  EXPECT_NO_THROW(ReadResumption(directory_, {}));
}

TEST_F(ResumptionTest, KeepsTheLatestFewCheckpoints) {
  for (int i = 0; i < 5; ++i) {
    Write(NextCheckpoint());
  }
  checkpoints_.Prune(2);
  EXPECT_EQ(checkpoints_.Latest(), (std::vector<Path>{checkpoints_.PathFor(5), checkpoints_.PathFor(4)}));
}

TEST_F(ResumptionTest, ClearsWhatAKilledProcessLeftHalfWritten) {
  const Path path = Write(NextCheckpoint());
  WriteFileAtomically(directory_ / "summary.json", R"({"completed": false})");
  WriteFileAtomically(path.string() + ".tmp123", "half");
  WriteFileAtomically(directory_ / "metrics.csv.tmp9", "half");
  WriteFileAtomically(directory_ / "notes.tmpl", "mine");
  const RunFolder folder(directory_, run_.experiment, RunFolder::Use::kResume);
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".tmp123"));
  EXPECT_FALSE(std::filesystem::exists(directory_ / "metrics.csv.tmp9"));
  EXPECT_FALSE(std::filesystem::exists(directory_ / "summary.json"));
  EXPECT_TRUE(std::filesystem::exists(directory_ / "notes.tmpl"));
  EXPECT_TRUE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace fresco
