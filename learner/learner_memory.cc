#include "learner/learner_memory.h"

#include "learner/weight_publisher.h"
#include "msgs/versions_in_flight.h"
#include "storage/checkpoint_file.h"
#include "training/dqn.h"
#include "training/ledger.h"
#include "training/replay_memory.h"

namespace fresco {

MemoryNeed LearnerMemory(const Experiment& experiment) {
  constexpr int64_t kMega = 1'000'000;
  constexpr int64_t kStored = 2;  // the best and the final network, while their files are written
  const World world(experiment.scenario());
  const MlpShape shape = experiment.network_shape();
  const proto::Agent& agent = experiment.agent();
  const proto::Run& run = experiment.run();
  const int64_t parameters = shape.parameter_count();
  const int64_t network = parameters * static_cast<int64_t>(sizeof(Vector::Scalar));
  const int64_t versions = MostVersionsInFlight(experiment).both();
  const int64_t checkpoint = CheckpointBytes(parameters, 0, 0);
  const int64_t actions = agent.replay_capacity() + int64_t{world.maximum_transitions()};
  return {"learner",
          1,
          {{"agent.replay_capacity", "the replay memory",
            ReplayMemory::BytesFor(shape.inputs(), shape.outputs(), agent.replay_capacity()) +
                ActionHistory::BytesFor(agent.replay_capacity(), world.maximum_transitions()) +
                CheckpointBytes(0, 0, actions)},
           {"agent.batch_size", "a batch and the units' outputs for it",
            MiniBatch::BytesFor(shape.inputs(), shape.outputs(), agent.batch_size()) +
                Dqn::BatchBytes(shape, agent.batch_size())},
           {"agent.hidden_layers", "the networks, Adam's moments and their checkpoint",
            Dqn::ParameterBytes(shape) + kStored * network + checkpoint},
           {"schedule.window", "the versions of the networks that orders in flight can name",
            versions * (network + WeightPublisher::BytesPerVersion(parameters)) +
                CheckpointBytes(parameters, versions, 0) - checkpoint},
           {"schedule.window", "the episodes of the orders in flight",
            Ledger::BytesFor(world, MaximumOrdersInFlight(experiment.schedule().window()))},
           {"scenario.grid", "the field",
            world.bytes() + NetworkInput::BytesFor(world, experiment.network_input_options())},
           {"run.optimum_memory_mb", "the search for the exact optimum",
            run.optimum_limit_s() > 0 ? run.optimum_memory_mb() * kMega : 0},
           {"", "the program", kProgramBytes}}};
}

}  // namespace fresco
