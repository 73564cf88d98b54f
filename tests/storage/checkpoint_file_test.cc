#include "storage/checkpoint_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "storage/network_file.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

using testing::HasSubstr;

class CheckpointFile : public ::testing::Test {
 protected:
  CheckpointFile() : checkpoint_{Experiment::Parse("agent { hidden_layers: [3] }", "a test"), 0xfeedu, -5} {
    TrainingState& training = checkpoint_.training;
    training.progress = {11, 10, 700, 650, 690, 6, 2, 0.25, 1e-3, 0.5, 12.5};
    training.orders = {{{11, OrderKind::kEvaluate, 0, 9, 6, 2}, 640},
                       {{12, OrderKind::kTrain, 0.125, 9, 6, 2}, 650}};
    training.versions = {{NetworkKind::kCurrent, 6, 600, Shared(1)},
                         {NetworkKind::kTarget, 2, 600, Shared(2)}};
    training.current = Parameters(3);
    training.target = Parameters(4);
    training.adam = {650, 0.5, 0.75, Parameters(5), Parameters(6)};
    training.actions = {0, 19, 3, 32767};
    training.last_evaluation = Evaluation{5, 500, 8, false, {3, 1.5, 4.5}};
    training.best = BestNetwork{{4, 400, 7, true, {2, 1.25, 3.75}}, Shared(7)};
    checkpoint_.resumptions = 2;
    checkpoint_.wall_s = 3.5;
    checkpoint_.metrics = "a,b\n";
    checkpoint_.counters = {{"lost", 4}, {"received", 9}};
  }

  Vector Parameters(uint64_t seed) const {
    return InitialParameters(checkpoint_.experiment.network_shape(), seed);
  }
  std::shared_ptr<const Vector> Shared(uint64_t seed) const {
    return std::make_shared<const Vector>(Parameters(seed));
  }
  static std::string Refusal(const std::string& content) {
    const std::string error = ErrorOf([&] { ParseCheckpoint(content, "/runs/a/7.checkpoint"); });
    EXPECT_THAT(error, HasSubstr("/runs/a/7.checkpoint"));
    return error;
  }

  Checkpoint checkpoint_;
};

TEST_F(CheckpointFile, ReadsBackEveryField) {
  const Checkpoint read = ParseCheckpoint(SerializeCheckpoint(checkpoint_), "a test");
  EXPECT_EQ(read.experiment.Text(), checkpoint_.experiment.Text());
  EXPECT_EQ(read.arithmetic_fingerprint, 0xfeedu);
  EXPECT_EQ(read.run_id, -5);
  EXPECT_EQ(read.resumptions, 2);
  EXPECT_EQ(read.wall_s, 3.5);
  EXPECT_EQ(read.metrics, "a,b\n");
  EXPECT_EQ(read.counters, checkpoint_.counters);
  const TrainingState& training = read.training;
  EXPECT_EQ(training.progress.staleness_updates, 12.5);
  EXPECT_EQ(training.orders.at(0).order, checkpoint_.training.orders[0].order);
  EXPECT_EQ(training.orders.at(1).order, checkpoint_.training.orders[1].order);
  EXPECT_EQ(training.orders.at(1).updates_at_writing, 650);
  EXPECT_EQ(training.versions.at(1).version.kind, NetworkKind::kTarget);
  EXPECT_TRUE(*training.versions.at(1).parameters == Parameters(2));
  EXPECT_TRUE(training.current == Parameters(3));
  EXPECT_TRUE(training.target == Parameters(4));
  EXPECT_TRUE(training.adam.first_moment == Parameters(5));
  EXPECT_TRUE(training.adam.second_moment == Parameters(6));
  EXPECT_EQ(training.adam.beta2_power, 0.75);
  EXPECT_EQ(training.actions, checkpoint_.training.actions);
  EXPECT_EQ(training.last_evaluation->figures.average_aoi, 1.5);
  EXPECT_EQ(training.best->evaluation.version, 4);
  EXPECT_TRUE(*training.best->parameters == Parameters(7));
}

TEST_F(CheckpointFile, IsTheSameBytesWrittenAgain) {
  const std::string content = SerializeCheckpoint(checkpoint_);
  EXPECT_EQ(SerializeCheckpoint(ParseCheckpoint(content, "a test")), content);
}

TEST_F(CheckpointFile, RefusesEveryTruncation) {
  const std::string whole = SerializeCheckpoint(checkpoint_);
  for (size_t size = 0; size < whole.size(); ++size) {
    ASSERT_NE(Refusal(whole.substr(0, size)), "") << size << " of " << whole.size();
  }
}

TEST_F(CheckpointFile, RefusesEveryFlippedBitOfItsContent) {
  std::string content = SerializeCheckpoint(checkpoint_);
  for (size_t i = 40; i < content.size(); ++i) {  // before that: format and software version
    content[i] = static_cast<char>(content[i] ^ (1 << i % 8));
    ASSERT_NE(Refusal(content), "") << i;
    content[i] = static_cast<char>(content[i] ^ (1 << i % 8));
  }
}

TEST_F(CheckpointFile, SaysWhyItRefuses) {
  const std::string whole = SerializeCheckpoint(checkpoint_);
  EXPECT_THAT(Refusal(whole.substr(0, 100)), HasSubstr("cut short, at 100 bytes"));
  EXPECT_THAT(Refusal("P5 640 480"), HasSubstr("not a checkpoint"));
  EXPECT_THAT(Refusal(SerializeNetworkFile({checkpoint_.experiment, 1, 1, Parameters(1)})),
              HasSubstr("not a checkpoint"));
  checkpoint_.training.target.resize(3);
  EXPECT_THAT(Refusal(SerializeCheckpoint(checkpoint_)), HasSubstr("target: expected"));
}

TEST_F(CheckpointFile, KnowsItsOwnFilesFromOthers) {
  EXPECT_TRUE(LooksLikeCheckpoint(SerializeCheckpoint(checkpoint_)));
  EXPECT_FALSE(LooksLikeCheckpoint(SerializeNetworkFile({checkpoint_.experiment, 1, 1, Parameters(1)})));
  EXPECT_FALSE(LooksLikeCheckpoint(""));
}

}  // namespace
}  // namespace fresco
