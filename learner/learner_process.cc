#include "learner/learner_process.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "core/clock.h"
#include "core/error.h"
#include "core/identifier.h"
#include "core/signals.h"
#include "msgs/protocol_times.h"
#include "msgs/versions_in_flight.h"
#include "nn/mlp.h"
#include "storage/checkpoint_file.h"
#include "training/dqn.h"
#include "training/ledger.h"
#include "training/replay_memory.h"

namespace fresco {
namespace {

constexpr double kSecondsPerMicrosecond = 1e-6;

}  // namespace

LearnerProcess::LearnerProcess(const Experiment& experiment, Bus& bus, LearnerOptions options)
    : experiment_(experiment),
      options_(std::move(options)),
      bus_(&bus),
      node_(experiment_, options_.run_id, bus, ChannelsWithPrefix(experiment.run().channel_prefix())),
      trainer_(experiment_, Output(), LearnerThreads(experiment.run())),
      folder_(options_.folder, experiment_, options_.use) {}

bool LearnerProcess::Run() {
  RefuseUsedBus();
  begin_us_ = MonotonicMicroseconds();
  std::vector<uint64_t> seeds = EpisodesToPlan(experiment_);
  std::vector<std::shared_ptr<const Plan>> known = folder_.ReadOptimum(seeds);
  optimum_.emplace(experiment_.world(), std::move(seeds),
                   OptimumSearch::Limits{experiment_.run().optimum_limit_s(),
                                         int64_t{experiment_.run().optimum_memory_mb()} * 1'000'000},
                   std::move(known));
  BeginTraining();
  std::jthread network([this](std::stop_token stop) { Serve(std::move(stop)); });
  Train();
  wall_s_ = WallSeconds();
  WaitForOptimum();
  network.request_stop();
  network.join();
  if (network_error_) {
    std::rethrow_exception(network_error_);
  }
  WriteResults();
  return trainer_.finished();
}

TrainerOutput LearnerProcess::Output() {
  TrainerOutput output;
  output.order = [this](const Order& order) { node_.WriteOrder(order); };
  output.version = [this](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
    node_.OfferVersion(version, std::move(parameters));
  };
  output.evaluation = [this](const Evaluation& evaluation) {
    folder_.AddMetrics(evaluation, trainer_.progress(), WallSeconds());
    if (trainer_.best()->evaluation.version == evaluation.version) {
      folder_.WriteBest(*trainer_.best());
    }
  };
  output.updated = [this] {
    constexpr int64_t kUpdatesPerReport = 16;
    if (!updating_began_) {
      updating_began_ = UpdatingClocks();
    }
    if (trainer_.progress().updates % kUpdatesPerReport == 0) {
      Report();
    }
  };
  return output;
}

/// Throws UsageError if another learner is on the same channels: the two would share actors and bandwidth.
void LearnerProcess::RefuseUsedBus() {
  const int64_t until_us = MonotonicMicroseconds() + kFreeBusUs;
  while (MonotonicMicroseconds() < until_us && node_.foreign_run() == 0 && !StopSignal::Requested()) {
    bus_->Poll(until_us - MonotonicMicroseconds());
  }
  if (node_.foreign_run() != 0) {
    throw UsageError(
        fmt::format("run {} is already on {} with channel prefix {}; give this run a port of its own, e.g. "
                    "--lcm-url 'udpm://239.255.76.67:7668?ttl=0', or end the other one",
                    IdentifierText(node_.foreign_run()), experiment_.run().lcm_url(),
                    experiment_.run().channel_prefix()));
  }
}

void LearnerProcess::Serve(std::stop_token stop) {
  try {
    while (!stop.stop_requested()) {
      node_.Step();
      if (StateSignal::ConsumeRequest()) {
        spdlog::info("{}", node_.StateText());
      }
    }
    node_.AnnounceEnd();
  } catch (...) {
    network_error_ = std::current_exception();
    StopSignal::Request();
  }
}

void LearnerProcess::BeginTraining() {
  if (!options_.checkpoint) {
    trainer_.Begin();
    return;
  }
  const Checkpoint& checkpoint = *options_.checkpoint;
  folder_.RestoreMetrics(checkpoint.metrics);
  node_.RestoreCounters(FromMap(checkpoint.counters));
  resumptions_ = checkpoint.resumptions + 1;
  wall_before_s_ = checkpoint.wall_s;
  trainer_.Resume(checkpoint.training);
  if (trainer_.best()) {
    folder_.WriteBest(*trainer_.best());
  }
  spdlog::info("continuing after {} episodes and {} updates", trainer_.progress().episodes,
               trainer_.progress().updates);
  options_.checkpoint.reset();  // frees its memory
}

void LearnerProcess::Train() {
  constexpr int64_t kWaitUs = 200'000;
  next_checkpoint_us_ = MonotonicMicroseconds();
  while (!trainer_.finished() && !StopSignal::Requested() && !GivesUp()) {
    WriteCheckpointIfDue();
    if (const auto next = node_.WaitForNext(kWaitUs)) {
      trainer_.Commit(next->order, std::move(next->episode));
    }
    Report();
  }
  if (updating_began_) {
    const UpdatingFigures now = UpdatingClocks();
    updating_ = {now.wall_us - updating_began_->wall_us, now.updates - updating_began_->updates,
                 now.training_thread_us - updating_began_->training_thread_us,
                 now.learner_us - updating_began_->learner_us};
  }
  if (!trainer_.finished()) {
    spdlog::info("interrupted after {} updates", trainer_.progress().updates);
    WriteCheckpoint();
  }
  Report();
}

/// Everything since an arbitrary time. Call it on the training thread.
UpdatingFigures LearnerProcess::UpdatingClocks() const {
  return {MonotonicMicroseconds(), trainer_.progress().updates, ThreadProcessorMicroseconds(),
          ProcessProcessorMicroseconds()};
}

/// Whether no result has arrived for run.patience_s. Logs an error if so.
bool LearnerProcess::GivesUp() const {
  const double patience_s = experiment_.run().patience_s();
  const bool starved = patience_s > 0 && node_.StarvedSeconds() >= patience_s;
  if (starved) {
    spdlog::error(
        "giving up: no result for {:.0f} s (run.patience_s), waiting for {}; continue the run with: train "
        "--resume {}",
        patience_s, node_.WaitingFor(), options_.folder.string());
  }
  return starved;
}

void LearnerProcess::WriteCheckpointIfDue() {
  const double interval_s = experiment_.run().checkpoint_interval_s();
  const int64_t now_us = MonotonicMicroseconds();
  if (interval_s > 0 && now_us >= next_checkpoint_us_ && !folder_.CheckpointIsBusy()) {
    next_checkpoint_us_ = now_us + static_cast<int64_t>(interval_s / kSecondsPerMicrosecond);
    WriteCheckpoint();
  }
}

void LearnerProcess::WriteCheckpoint() {
  const int64_t begin_us = MonotonicMicroseconds();
  auto checkpoint = std::make_shared<Checkpoint>(
      Checkpoint{experiment_, ArithmeticFingerprint(), options_.run_id, trainer_.Save()});
  checkpoint->resumptions = resumptions_;
  checkpoint->wall_s = trainer_.finished() ? wall_s_ : WallSeconds();
  checkpoint->metrics = folder_.metrics();
  checkpoint->counters = ToMap(node_.counters());
  folder_.WriteCheckpoint(std::move(checkpoint));
  folder_.WriteOptimum(optimum_->seeds(), optimum_->plans());
  ++checkpoints_.taken;
  checkpoints_.longest_pause_us = std::max(checkpoints_.longest_pause_us, MonotonicMicroseconds() - begin_us);
}

/// Waits until the search for the optimum ends, which may take longer than a short training. If the training
/// was interrupted, stops the search at once. If the program is asked to stop during the wait, the training
/// still counts as complete, and a checkpoint of its end is written so that --resume can continue the search.
void LearnerProcess::WaitForOptimum() {
  constexpr int64_t kReportUs = 200'000;
  if (trainer_.finished()) {
    optimum_->SetFullPriority();
  }
  while (trainer_.finished() && !StopSignal::Requested() && !optimum_->WaitForEnd(kReportUs)) {
    finishing_ = fmt::format("the proof of the exact optimum: at most {:.0f} s more of processor time",
                             optimum_->processor_seconds_left());
    Report();
  }
  optimum_->Stop();
  if (trainer_.finished() && optimum_->result().end == SearchEnd::kStopped) {
    spdlog::info("the search for the exact optimum was stopped");
    WriteCheckpoint();
  }
  Report();
}

void LearnerProcess::Report() {
  node_.Report({trainer_.progress(), trainer_.last_evaluation(), trainer_.best(), optimum_->bounds(),
                finishing_, folder_.problem()});
}

double LearnerProcess::WallSeconds() const {
  return wall_before_s_ + static_cast<double>(MonotonicMicroseconds() - begin_us_) * kSecondsPerMicrosecond;
}

void LearnerProcess::WriteResults() {
  const OptimumResult optimum = optimum_->result();
  folder_.WriteOptimum(optimum_->seeds(), optimum.plans);
  folder_.WriteFinal(trainer_.current(), trainer_.progress());
  folder_.Finish();
  const ProcessorFigures processor = {ProcessProcessorMicroseconds(), ThreadProcessorMicroseconds(),
                                      node_.ActorProcessorMicroseconds()};
  folder_.WriteSummary(
      SummaryJson({experiment_, options_.run_id, trainer_.finished(), wall_s_, trainer_, node_.counters(),
                   optimum, resumptions_, checkpoints_, updating_, processor}));
}

MemoryNeed LearnerMemory(const Experiment& experiment) {
  constexpr int64_t kMega = 1'000'000;
  constexpr int64_t kStored = 2;  // the best and the final network, while their files are written
  const World& world = experiment.world();
  const Network& network = *experiment.network();
  const proto::Agent& agent = experiment.agent();
  const proto::Run& run = experiment.run();
  const int64_t parameters = network.parameter_count();
  const int64_t network_bytes = parameters * static_cast<int64_t>(sizeof(Vector::Scalar));
  const int64_t versions = MostVersionsInFlight(experiment).both();
  const int64_t checkpoint = CheckpointBytes(parameters, 0, 0);
  const int64_t episodes = EpisodeHistory::BytesFor(world, agent.replay_capacity());
  return {"learner",
          1,
          {{"agent.replay_capacity", "the replay memory",
            ReplayMemory::BytesFor(network.inputs(), network.outputs(), agent.replay_capacity()) + episodes +
                CheckpointBytes(0, 0, CheckpointedEpisodeBytes(world, agent.replay_capacity()))},
           {"agent.batch_size", "a batch and the units' outputs for it",
            MiniBatch::BytesFor(network.inputs(), network.outputs(), agent.batch_size()) +
                Dqn::BatchBytes(network, agent.batch_size(), LearnerThreads(run))},
           {experiment.network_field(), "the networks, Adam's moments and their checkpoint",
            Dqn::ParameterBytes(network) + kStored * network_bytes + checkpoint},
           {"schedule.window", "the versions of the networks that orders in flight can name",
            versions * (network_bytes + WeightPublisher::BytesPerVersion(parameters)) +
                CheckpointBytes(parameters, versions, 0) - checkpoint},
           {"schedule.window", "the episodes of the orders in flight",
            Ledger::BytesFor(world, MaximumOrdersInFlight(experiment.schedule()))},
           {"world", "the world", world.bytes()},
           {"run.optimum_memory_mb", "the search for the exact optimum",
            !EpisodesToPlan(experiment).empty() && run.optimum_limit_s() > 0 ? run.optimum_memory_mb() * kMega
                                                                             : 0},
           {"", "the program", kProgramBytes}}};
}

}  // namespace fresco
