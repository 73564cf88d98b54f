#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "core/help_formatter.h"
#include "exports/exports.h"
#include "msgs/ready_experiments.h"
#include "storage/policy.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct ExportPolicyOptions {
  PolicyChoice choice;
  std::string format;
  std::string name = "fresco_policy";
  std::string out;
};

int ExportPolicy(const ExportPolicyOptions& options) {
  ChosenPolicy chosen = ReadChoice(options.choice);
  if (!chosen.network) {
    throw UsageError(fmt::format("--policy: expected a trained policy; found {}, which has no network",
                                 options.choice.policy));
  }
  // In the world of --config, if there is one.
  const StoredNetwork network{std::move(chosen.experiment), chosen.network->version, chosen.network->updates,
                              std::move(chosen.network->parameters)};
  const std::string content = options.format == "onnx"  ? OnnxModel(network)
                              : options.format == "cpp" ? CppHeader(network, options.name)
                                                        : ParametersCsv(network);
  WriteFileAtomically(options.out, content);
  const World& world = network.experiment.world();
  fmt::print("{}: {} ({} bytes); states of {} fields, {} actions\n", options.out, options.format,
             content.size(), world.state_size(), world.actions());
  return 0;
}

}  // namespace

void AddExport(CLI::App& app, Command& command) {
  auto options = std::make_shared<ExportPolicyOptions>();
  CLI::App* exporting = app.add_subcommand(
      "export", "Write a trained policy in a format that other programs read: ONNX, a C++ header, CSV");
  exporting
      ->add_option("--policy", options->choice.policy,
                   "The folder of a run (with a best.network), a network file or a checkpoint")
      ->type_name("POLICY")
      ->required();
  exporting->add_option("--config", options->choice.config, ConfigHelp("the one of the policy"))
      ->type_name("EXPERIMENT");
  exporting->add_option("--set", options->choice.settings, "Override one field: path=value; may be repeated")
      ->type_name("PATH=VALUE");
  exporting
      ->add_option("--format", options->format,
                   "onnx: a model from states to actions; cpp: a header without dependencies, from states to "
                   "actions; csv: the network's parameters")
      ->required()
      ->check(OneOf({"onnx", "cpp", "csv"}));
  exporting->add_option("--out", options->out, "The file to write")->type_name("FILE")->required();
  exporting->add_option("--name", options->name, "For cpp: the namespace; default: fresco_policy")
      ->type_name("NAME");
  exporting->footer(
      HelpExamples({"fresco export --policy runs/NAME --format onnx --out policy.onnx",
                    "fresco export --policy runs/NAME --format cpp --out policy.h --name uav_policy"}));
  exporting->callback([options, &command] { command = [options] { return ExportPolicy(*options); }; });
}

}  // namespace fresco
