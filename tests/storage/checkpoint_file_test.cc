#include "storage/checkpoint_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "storage/network_file.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

using testing::HasSubstr;

class CheckpointFile : public ::testing::Test {
 protected:
  // The world of a plug-in is not repeatable, so its episodes are written whole.
  CheckpointFile()
      : checkpoint_{Experiment::Parse("plugin { library: \"" FRESCO_PLUGIN_FOLDER "/faulty_world.so\" } "
                                      "agent { hidden_layers: [3] }",
                                      "a test"),
                    0xfeedu, -5} {
    TrainingState& training = checkpoint_.training;
    training.progress = {11, 10, 700, 650, 690, 6, 2, 0.25, 1e-3, 0.5, 12.5, true};
    training.orders = {{{11, OrderKind::kEvaluate, 0, 0, 0, 9, 6, 2}, 640},
                       {{12, OrderKind::kTrain, 0.125, 16, 3, 9, 6, 2}, 650}};
    training.versions = {{{NetworkKind::kCurrent, 6}, 600, Shared(1)},
                         {{NetworkKind::kTarget, 2}, 600, Shared(2)}};
    training.current = Parameters(3);
    training.target = Parameters(4);
    training.adam = {650, 0.5, 0.75, Parameters(5), Parameters(6)};
    training.replay = {std::make_shared<const Episode>(Truncated()),
                       std::make_shared<const Episode>(Terminal())};
    training.partial_evaluation = {3, 2, {4.5, 700, 13.5}, {1, 1.5, 2}};
    training.last_evaluation = Evaluation{5, 500, 8, 0.25, {1.5, 3, 4.5}, {1.25, 1.75}};
    training.best = BestNetwork{{4, 400, 7, 0.75, {1.25, 2, 3.75}, {1.25}}, Shared(7)};
    training.delivered = Evaluation{6, 600, 10, 0.5, {1.125, 5, 6.5}, {1, 1.25}};
    checkpoint_.resumptions = 2;
    checkpoint_.wall_s = 3.5;
    checkpoint_.metrics = "a,b\n";
    checkpoint_.counters = {{"lost", 4}, {"received", 9}};
  }

  /// Two transitions of two fields; the last state has a value like any other.
  static Episode Truncated() {
    return {9,          Ending::kTruncated, {0, -1.5f, 1e-30f, 3.25f, -3e38f, 7},
            {0, 32767}, {-0.0f, 0.5f},      {0xff, 0x01, 0x80, 0x00}};
  }
  static Episode Terminal() { return {8, Ending::kTerminal, {1, 2, 3, 4}, {19}, {-2}, {0x03, 0x04}}; }

  static void ExpectEqual(const Evaluation& read, const Evaluation& written) {
    EXPECT_EQ(read.version, written.version);
    EXPECT_EQ(read.updates, written.updates);
    EXPECT_EQ(read.episodes, written.episodes);
    EXPECT_EQ(read.success, written.success);
    EXPECT_EQ(read.figures, written.figures);
    EXPECT_EQ(read.scores, written.scores);
  }
  /// What is said of a checkpoint with such an episode in its replay memory.
  std::string RefusalOf(const Episode& episode) {
    checkpoint_.training.replay = {std::make_shared<const Episode>(episode)};
    return Refusal(SerializeCheckpoint(checkpoint_));
  }

  Vector Parameters(uint64_t seed) const { return checkpoint_.experiment.network()->InitialParameters(seed); }
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
  EXPECT_TRUE(training.progress.delivering);
  ASSERT_EQ(training.replay.size(), 2u);
  EXPECT_TRUE(SameBits(*training.replay[0], Truncated()));
  EXPECT_TRUE(SameBits(*training.replay[1], Terminal()));
  EXPECT_EQ(training.replay[0]->seed, 9u);
  EXPECT_EQ(training.partial_evaluation.episodes, 3);
  EXPECT_EQ(training.partial_evaluation.successes, 2);
  EXPECT_EQ(training.partial_evaluation.figures, (std::vector<double>{4.5, 700, 13.5}));
  EXPECT_EQ(training.partial_evaluation.scores, (std::vector<double>{1, 1.5, 2}));
  ExpectEqual(*training.last_evaluation, *checkpoint_.training.last_evaluation);
  ExpectEqual(training.best->evaluation, checkpoint_.training.best->evaluation);
  ExpectEqual(*training.delivered, *checkpoint_.training.delivered);
  EXPECT_TRUE(*training.best->parameters == Parameters(7));
}

TEST_F(CheckpointFile, SaysThatThereIsNoEvaluationYet) {
  TrainingState& training = checkpoint_.training;
  training.partial_evaluation = {};
  training.last_evaluation.reset();
  training.best.reset();
  training.delivered.reset();
  training.replay.clear();
  training.progress.delivering = false;
  const TrainingState read = ParseCheckpoint(SerializeCheckpoint(checkpoint_), "a test").training;
  EXPECT_EQ(read.partial_evaluation.episodes, 0);
  EXPECT_TRUE(read.partial_evaluation.figures.empty());
  EXPECT_FALSE(read.last_evaluation || read.best || read.delivered);
  EXPECT_TRUE(read.replay.empty());
  EXPECT_FALSE(read.progress.delivering);
}

TEST_F(CheckpointFile, RefusesEpisodesThatAreNone) {
  Episode episode = Truncated();
  episode.ending = Ending::kNone;
  EXPECT_THAT(RefusalOf(episode), HasSubstr("replay: found an episode with the ending 0"));
  episode.ending = static_cast<Ending>(3);
  EXPECT_THAT(RefusalOf(episode), HasSubstr("replay: found an episode with the ending 3"));
  episode = Terminal();
  episode.states[1] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(RefusalOf(episode), HasSubstr("replay: found a state that is not finite"));
}

TEST_F(CheckpointFile, HoldsOnlySeedsAndActionsOfARepeatableWorld) {
  const Experiment cartpole = Experiment::Parse("cartpole {} agent { hidden_layers: [3] }", "a test");
  const auto random_vector = [&](uint64_t seed) { return cartpole.network()->InitialParameters(seed); };
  Checkpoint checkpoint{cartpole, 0xfeedu, -5};
  checkpoint.training.current = checkpoint.training.target = random_vector(1);
  checkpoint.training.adam = {0, 1, 1, random_vector(2), random_vector(3)};
  const size_t without = SerializeCheckpoint(checkpoint).size();
  Episode episode;
  ASSERT_TRUE(FlyActions(cartpole.world(), 7, std::vector<int16_t>(500, 1), episode));
  checkpoint.training.replay = {std::make_shared<const Episode>(episode)};
  const std::string content = SerializeCheckpoint(checkpoint);
  EXPECT_LT(content.size(), without + 2 * episode.actions.size() + 32);
  const TrainingState read = ParseCheckpoint(content, "a test").training;
  ASSERT_EQ(read.replay.size(), 1u);
  EXPECT_TRUE(SameBits(*read.replay[0], episode));
  EXPECT_EQ(read.replay[0]->seed, 7u);
  for (const auto& change : std::vector<std::function<void(Episode&)>>{
           [](Episode& changed) { changed.actions.pop_back(); },      // it has not ended yet
           [](Episode& changed) { changed.actions.push_back(1); },    // it had ended before
           [](Episode& changed) { changed.actions.front() = 2; }}) {  // there is no such action
    Episode changed = episode;
    change(changed);
    checkpoint.training.replay = {std::make_shared<const Episode>(changed)};
    EXPECT_THAT(Refusal(SerializeCheckpoint(checkpoint)), HasSubstr("no complete episode of this world"));
  }
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
