// The program fresco-learner: the learner process of one run; see learner/learner_process.h.
#include <spdlog/spdlog.h>

#include "bus/open_bus.h"
#include "core/command_line.h"
#include "core/error.h"
#include "core/files.h"
#include "core/identifier.h"
#include "core/installation.h"
#include "learner/learner_process.h"
#include "msgs/experiment.h"
#include "msgs/ready_experiments.h"
#include "nn/arithmetic.h"
#include "nn/arithmetic_option.h"
#include "storage/checkpoint_folder.h"

namespace fresco {
namespace {

struct Arguments {
  std::string config = kDefaultExperiment;
  std::vector<std::string> settings;
  std::string lcm_url;
  std::string out;
  std::string resume;
  std::string run_id;
  BusOptions bus;
};

int Run(const Experiment& experiment, Bus& bus, LearnerOptions options) {
  spdlog::info("run {}, configuration {:08x}, on {}; arithmetic {}", IdentifierText(options.run_id),
               experiment.hash(), experiment.run().lcm_url(), CurrentArithmetic().name);
  return LearnerProcess(experiment, bus, std::move(options)).Run() ? 0 : 1;
}

int64_t RunIdFrom(const Arguments& arguments) {
  return arguments.run_id.empty() ? DrawIdentifier() : ParseRunId(arguments.run_id);
}

int RunAnew(const Arguments& arguments, const Settings& settings) {
  if (arguments.out.empty()) {
    throw UsageError("--out: expected the run's folder, found none; give --out DIR, or --resume DIR");
  }
  // Check everything before making the folder, so that wrong use leaves nothing behind.
  const Experiment experiment =
      RunFolder::WithStart(Experiment::Load(ExperimentPath(arguments.config), settings), arguments.out);
  RefuseIfTooLarge({LearnerMemory(experiment)}, ReadAvailableMemory());
  const int64_t run_id = RunIdFrom(arguments);
  RunFolder::CheckNew(arguments.out);
  const std::unique_ptr<Bus> bus = OpenBus(experiment.run().lcm_url(), arguments.bus);
  RunFolder::Make(arguments.out);
  const FolderLock lock(arguments.out);
  return Run(experiment, *bus, {arguments.out, run_id});
}

int Resume(const Arguments& arguments, const Settings& settings) {
  const FolderLock lock(arguments.resume, kResumePatienceUs);
  Resumption resumption = ReadResumption(arguments.resume, settings);
  RefuseIfTooLarge({LearnerMemory(resumption.experiment)}, ReadAvailableMemory());
  const int64_t run_id = resumption.checkpoint ? resumption.checkpoint->run_id : RunIdFrom(arguments);
  CheckOutputFolder(arguments.resume, "--resume");
  const std::unique_ptr<Bus> bus = OpenBus(resumption.experiment.run().lcm_url(), arguments.bus);
  SetAside(resumption.unusable);
  return Run(resumption.experiment, *bus,
             {arguments.resume, run_id, RunFolder::Use::kResume, std::move(resumption.checkpoint)});
}

int Main(int argc, char** argv) {
  Arguments arguments;
  Program program(
      "fresco-learner",
      "Trains a DQN from the transitions that actors send over LCM. `fresco train` starts it for you.",
      LogStyle::kTimed, {kSourceCommit, CurrentArithmetic().name});
  CLI::App& app = program.command_line();
  CLI::Option* config = app.add_option("--config", arguments.config, ConfigHelp())->type_name("EXPERIMENT");
  app.add_option("--set", arguments.settings, "Overrides one field: path=value; may be repeated")
      ->type_name("PATH=VALUE");
  app.add_option("--lcm-url", arguments.lcm_url, "Overrides run.lcm_url")->type_name("URL");
  CLI::Option* out = app.add_option("--out", arguments.out, "The run's folder")->type_name("FOLDER");
  app.add_option("--resume", arguments.resume, "Continue the run in this folder from its latest checkpoint")
      ->type_name("FOLDER")
      ->excludes(config)
      ->excludes(out);
  app.add_option("--run-id", arguments.run_id, "Id of the run (16 hexadecimal digits); default: a random id")
      ->type_name("RUN_ID");
  AddBusOptions(app, arguments.bus);
  AddArithmeticOption(app);
  return program.Run(argc, argv, [&] {
    Settings settings = ParseSettings(arguments.settings);
    if (!arguments.lcm_url.empty()) {
      settings.emplace_back("run.lcm_url", arguments.lcm_url);
    }
    return arguments.resume.empty() ? RunAnew(arguments, settings) : Resume(arguments, settings);
  });
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  return fresco::Main(argc, argv);
}
