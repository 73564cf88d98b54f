#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "core/signals.h"
#include "report/result_display.h"
#include "storage/policy.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct EvaluateOptions {
  PolicyChoice choice;
  std::string format = "text";
};

void PrintText(const FlownPolicy& flown, const std::string& policy) {
  fmt::print("slot  cell      move   scheduled  AoI\n");
  for (size_t slot = 0; slot < flown.flight.states.size(); ++slot) {
    const State& state = flown.flight.states[slot];
    const Action action = ActionIn(flown.world, flown.flight, slot);
    const std::string cell = fmt::format("({},{})", state.cell.column, state.cell.row);
    fmt::print("{:>4}  {:<8}  {:<5}  {:>9}  {}\n", state.slot, cell, MoveName(action.move),
               action.schedule == 0 ? "-" : std::to_string(action.schedule), fmt::join(state.aoi, " "));
  }
  fmt::print("\n{}\n", FlightSummary(flown, policy));
}

void PrintProof(const Plan& plan) {
  if (plan.optimal) {
    fmt::print("This is the exact optimum: no flight has a smaller average AoI.\n");
  } else {
    const double average_aoi = plan.lower_bound_average_aoi;
    fmt::print(
        "The search was stopped early: no flight has an average AoI below {:.3f} (total AoI {:.1f}).\n",
        average_aoi, plan.lower_bound_total_aoi);
  }
}

int Evaluate(const EvaluateOptions& options) {
  const FlownPolicy flown = FlyPolicy(options.choice, ReadChoice(options.choice));
  if (options.format == "json") {
    fmt::print("{}\n", FlightJson(flown.world, flown.flight, options.choice.policy, flown.plan));
    return StopSignal::Requested() ? 1 : 0;
  }
  PrintText(flown, options.choice.policy);
  if (flown.plan) {
    PrintProof(*flown.plan);
  }
  return StopSignal::Requested() ? 1 : 0;
}

}  // namespace

void AddEvaluate(CLI::App& app, Command& command) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* evaluate = app.add_subcommand("evaluate", "Fly one episode greedily and show it slot by slot");
  AddPolicyOptions(*evaluate, options->choice);
  evaluate->add_option("--format", options->format, "text or json")->check(OneOf({"text", "json"}));
  options->choice.limits.show_progress = true;
  evaluate->callback([options, &command] { command = [options] { return Evaluate(*options); }; });
}

}  // namespace fresco
