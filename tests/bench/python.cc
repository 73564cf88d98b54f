// The program fresco-bench-python: Debian's Python interpreter with one more module, fresco_experiment. With
// it a script trains in Fresco's own world of an experiment, with the hyperparameters of the same file
// (tests/bench/pytorch_dqn.py). Arrays of environments are Fresco's memory; nothing is copied.
//
// It is an interpreter with a built-in module, and no module in a shared library, because Fresco's libraries
// are compiled for programs. It has Debian's static libpython, as /usr/bin/python3 has: the shared one is
// slower.
#include <pybind11/embed.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "msgs/experiment.h"
#include "msgs/ready_experiments.h"
#include "nn/mlp.h"
#include "planner/planner.h"
#include "tests/bench/environment_batch.h"
#include "training/dqn.h"
#include "training/schedules.h"

namespace py = pybind11;

namespace fresco {
namespace {

template <class Value>
using Array = py::array_t<Value, py::array::c_style>;  // without forcecast: another type is an error

template <class Value>
std::span<const Value> ValuesOf(const Array<Value>& array) {
  return {array.data(), static_cast<size_t>(array.size())};
}

/// An array that is the memory of `values`, which `owner` keeps alive. A vector of bytes becomes booleans.
template <class Value, class Shown = Value>
py::array View(std::vector<Value>& values, py::object owner, int rows) {
  static_assert(sizeof(Value) == sizeof(Shown));
  const auto count = static_cast<py::ssize_t>(values.size());
  const std::vector<py::ssize_t> shape =
      count == rows ? std::vector<py::ssize_t>{count} : std::vector<py::ssize_t>{rows, count / rows};
  return py::array(py::dtype::of<Shown>(), shape, values.data(), owner);
}

/// The layers of the experiment's flat network. Throws UsageError if it has another one.
MlpShape ShapeOf(const Experiment& experiment) {
  if (experiment.agent().has_set_network()) {
    throw UsageError(
        "agent.set_network: expected a flat network (agent.hidden_layers); the peer has no other");
  }
  if (experiment.agent().n_step() > 1 || experiment.schedule().has_search() ||
      experiment.agent().has_start_crc32c()) {
    throw UsageError(
        "expected agent.n_step 1, no schedule.search and no agent.start_crc32c; the peer has none of them");
  }
  return MlpShape(experiment.network()->layer_sizes());
}

/// The parameters of each layer in the shapes of torch.nn.Linear: weights [outputs x inputs], biases
/// [outputs].
py::list LayersOf(const MlpShape& shape, const Vector& parameters) {
  py::list layers;
  const float* next = parameters.data();
  const std::vector<int>& sizes = shape.layer_sizes();
  for (size_t i = 1; i < sizes.size(); ++i) {
    const py::array_t<float, py::array::f_style> weights(std::vector<py::ssize_t>{sizes[i], sizes[i - 1]},
                                                         next);
    next += weights.size();
    const py::array_t<float> biases(sizes[i], next);
    next += biases.size();
    layers.append(py::make_tuple(weights, biases));
  }
  return layers;
}

/// The score of the exact optimum; none if nothing proves it.
std::optional<double> OptimumOf(const Experiment& experiment) {
  if (!CanPlan(experiment.world())) {
    return std::nullopt;
  }
  const Plan plan = PlanOptimally(experiment.world(), 0);
  std::vector<double> figures(experiment.world().description().figures.size());
  experiment.world().Judge(plan.flight, figures);
  return plan.optimal ? std::optional(figures.front()) : std::nullopt;
}

Array<int32_t> DrawPlaces(const Experiment& experiment, uint64_t seed, int count) {
  Array<int32_t> places(count);
  RandomStream stream(seed, RandomPurpose::kTest, 0, 0);
  for (int i = 0; i < count; ++i) {
    places.mutable_at(i) = experiment.world().DrawPlace(stream);
  }
  return places;
}

py::array_t<double> FiguresOf(const EnvironmentBatch& batch, int environments) {
  const size_t count = batch.world().description().figures.size();
  py::array_t<double> figures({static_cast<py::ssize_t>(environments), static_cast<py::ssize_t>(count)});
  for (int i = 0; i < environments; ++i) {
    batch.world().Judge(batch.episode(i), {figures.mutable_data(i, 0), count});
  }
  return figures;
}

std::vector<bool> SuccessesOf(const EnvironmentBatch& batch, int environments) {
  std::vector<bool> successes;
  for (int i = 0; i < environments; ++i) {
    successes.push_back(batch.world().Succeeded(batch.episode(i)));
  }
  return successes;
}

/// The learner's own update, so that a test can hold a peer's against it.
class LearnerUpdate {
 public:
  explicit LearnerUpdate(const Experiment& experiment)
      : shape_(ShapeOf(experiment)),
        dqn_(experiment.network(), experiment.network()->InitialParameters(experiment.schedule().seed()),
             {experiment.agent().double_dqn(),
              experiment.agent().batch_size(),
              {experiment.agent().adam().beta1(), experiment.agent().adam().beta2(),
               experiment.agent().adam().epsilon()}}),
        batch_(experiment.network()->inputs(), experiment.network()->outputs(),
               experiment.agent().batch_size()) {}

  double Update(const Array<float>& observations, const Array<int16_t>& actions, const Array<float>& rewards,
                const Array<float>& next_observations, const Array<float>& discounts,
                const Array<bool>& next_masks, const Array<float>& least_values, double learning_rate) {
    Fill(observations, batch_.observations.data(), batch_.observations.size());
    Fill(next_observations, batch_.next_observations.data(), batch_.next_observations.size());
    Fill(actions, batch_.actions.data(), batch_.size());
    Fill(rewards, batch_.rewards.data(), batch_.size());
    Fill(discounts, batch_.discounts.data(), batch_.size());
    Fill(next_masks, batch_.next_masks.data(), static_cast<int64_t>(batch_.next_masks.size()));
    Fill(least_values, batch_.least_values.data(), batch_.size());
    return dqn_.Update(batch_, learning_rate);
  }
  void CopyToTarget() { dqn_.CopyToTarget(); }
  py::list Layers() const { return LayersOf(shape_, dqn_.current()); }

 private:
  template <class From, class To>
  static void Fill(const Array<From>& from, To* to, int64_t count) {
    static_assert(sizeof(From) == sizeof(To));
    FRESCO_CHECK(from.size() == count);
    std::memcpy(to, from.data(), static_cast<size_t>(count) * sizeof(To));
  }

  MlpShape shape_;
  Dqn dqn_;
  MiniBatch batch_;
};

/// Agent and Schedule have the fields of msgs/proto/experiment.proto.
void DefineHyperparameters(py::module_& module) {
  py::class_<proto::AdamOptions>(module, "AdamOptions")
      .def_property_readonly("beta1", &proto::AdamOptions::beta1)
      .def_property_readonly("beta2", &proto::AdamOptions::beta2)
      .def_property_readonly("epsilon", &proto::AdamOptions::epsilon);
  py::class_<proto::Agent>(module, "Agent")
      .def_property_readonly("double_dqn", &proto::Agent::double_dqn)
      .def_property_readonly("discount", &proto::Agent::discount)
      .def_property_readonly("replay_capacity", &proto::Agent::replay_capacity)
      .def_property_readonly("batch_size", &proto::Agent::batch_size)
      .def_property_readonly("target_update_period", &proto::Agent::target_update_period)
      .def_property_readonly("adam", &proto::Agent::adam)
      .def_property_readonly("flown_return_bound", &proto::Agent::flown_return_bound);
  py::class_<proto::Schedule>(module, "Schedule")
      .def_property_readonly("seed", &proto::Schedule::seed)
      .def_property_readonly("episodes", &proto::Schedule::episodes)
      .def_property_readonly("inserts_per_update", &proto::Schedule::inserts_per_update)
      .def_property_readonly("minimum_replay_size", &proto::Schedule::minimum_replay_size)
      .def_property_readonly("window", &proto::Schedule::window)
      .def_property_readonly("updates_per_version", &proto::Schedule::updates_per_version)
      .def_property_readonly("versions_per_evaluation", &proto::Schedule::versions_per_evaluation)
      .def_property_readonly("excursion_share", &proto::Schedule::excursion_share)
      .def_property_readonly("evaluation_episodes", &proto::Schedule::evaluation_episodes);
}

void DefineExperiment(py::module_& module) {
  py::class_<Experiment>(module, "Experiment")
      // A file or a ready experiment, and settings such as "schedule.seed=2".
      .def(py::init([](const std::string& config, const std::vector<std::string>& settings) {
             return Experiment::Load(ExperimentPath(config), ParseSettings(settings));
           }),
           py::arg("config"), py::arg("settings") = std::vector<std::string>())
      .def_property_readonly("agent", &Experiment::agent)
      .def_property_readonly("schedule", &Experiment::schedule)
      .def_property_readonly("layer_sizes",
                             [](const Experiment& self) { return ShapeOf(self).layer_sizes(); })
      .def_property_readonly("longest_episode",
                             [](const Experiment& self) { return self.world().longest_episode(); })
      .def_property_readonly("action_names",
                             [](const Experiment& self) { return self.world().description().actions; })
      .def_property_readonly("less_is_better",
                             [](const Experiment& self) { return self.world().description().less_is_better; })
      .def("epsilon", [](const Experiment& self, int64_t episode,
                         int64_t transitions) { return EpsilonOf(self.schedule(), episode, transitions); })
      .def("learning_rate",
           [](const Experiment& self, int64_t updates, int64_t episodes) {
             return LearningRateOf(self.agent(), updates, episodes,
                                   ExpectedUpdates(self.schedule(), self.world().longest_episode()));
           })
      .def("episode_seed", [](const Experiment& self,
                              int64_t episode) { return EpisodeSeed(self.schedule().seed(), episode); })
      .def("evaluation_seed", [](const Experiment& self,
                                 int64_t episode) { return EvaluationSeed(self.schedule().seed(), episode); })
      .def("initial_layers",
           [](const Experiment& self) {
             return LayersOf(ShapeOf(self), self.network()->InitialParameters(self.schedule().seed()));
           })
      .def("draw_places", DrawPlaces)
      .def("optimum", OptimumOf);
}

void DefineEnvironments(py::module_& module) {
  using Batch = EnvironmentBatch;
  const auto self_of = [](const py::object& object) -> Batch& { return object.cast<Batch&>(); };
  py::class_<Batch>(module, "Environments")
      .def(py::init<const Experiment&, int>())
      .def_property_readonly("observations",
                             [=](const py::object& object) {
                               Batch& self = self_of(object);
                               return View(self.observations(), object, self.count());
                             })
      .def_property_readonly("masks",
                             [=](const py::object& object) {
                               Batch& self = self_of(object);
                               return View<uint8_t, bool>(self.masks(), object, self.count());
                             })
      .def_property_readonly("rewards",
                             [=](const py::object& object) {
                               Batch& self = self_of(object);
                               return View(self.rewards(), object, self.count());
                             })
      .def_property_readonly("endings",
                             [=](const py::object& object) {
                               Batch& self = self_of(object);
                               return View(self.endings(), object, self.count());
                             })
      .def("reset", [](Batch& self, const std::vector<uint64_t>& seeds) { self.Reset(seeds); })
      .def("step", [](Batch& self, const Array<int64_t>& actions) { return self.Step(ValuesOf(actions)); })
      .def("are_at",
           [](const Batch& self, const Array<int32_t>& places) {
             Array<bool> at(self.count());
             self.AreAt(ValuesOf(places),
                        {reinterpret_cast<uint8_t*>(at.mutable_data()), static_cast<size_t>(at.size())});
             return at;
           })
      .def("masks_towards",
           [](const Batch& self, const Array<int32_t>& places) {
             Array<bool> masks({self.count(), self.world().actions()});
             self.MasksTowards(ValuesOf(places), {reinterpret_cast<uint8_t*>(masks.mutable_data()),
                                                  static_cast<size_t>(masks.size())});
             return masks;
           })
      .def("figures", FiguresOf)
      .def("successes", SuccessesOf);
}

}  // namespace
}  // namespace fresco

PYBIND11_EMBEDDED_MODULE(fresco_experiment, module) {
  fresco::DefineHyperparameters(module);
  fresco::DefineExperiment(module);
  fresco::DefineEnvironments(module);
  py::class_<fresco::LearnerUpdate>(module, "LearnerUpdate")
      .def(py::init<const fresco::Experiment&>())
      .def("update", &fresco::LearnerUpdate::Update)
      .def("copy_to_target", &fresco::LearnerUpdate::CopyToTarget)
      .def_property_readonly("layers", &fresco::LearnerUpdate::Layers);
  module.def("gap_percent", fresco::GapPercent);
}

int main(int argc, char** argv) {
  return Py_BytesMain(argc, argv);
}
