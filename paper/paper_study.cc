#include "paper/paper_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

/// The rotor parameters that are usual in the literature (Zeng, Xu and Zhang, "Energy Minimization for
/// Wireless Communication with Rotary-Wing UAV", 2019). Flying at 25 m/s takes 249 W, hovering takes 168.5 W.
void SetDearFlight(proto::Rotor& rotor) {
  rotor.set_blade_profile_power_w(79.86);
  rotor.set_induced_power_w(88.63);
  rotor.set_tip_speed_mps(120);
  rotor.set_induced_velocity_mps(4.03);
  rotor.set_drag_ratio(0.6);
  rotor.set_solidity(0.05);
  rotor.set_disk_area_m2(0.503);
}

Experiment WithDeployment(const Experiment& base, int sensors, int radius_cells, int deployment) {
  proto::ExperimentConfig config = base.config();
  proto::Scenario& scenario = *config.mutable_scenario();
  scenario.clear_sensor();
  scenario.mutable_random_sensors()->set_count(sensors);
  scenario.mutable_random_sensors()->set_seed(static_cast<uint64_t>(deployment));
  scenario.set_coverage_radius_m(radius_cells * scenario.grid().cell_m());
  return Experiment::Make(config, fmt::format("{} sensors at R = {}", sensors, radius_cells));
}

class StudyMaker {
 public:
  StudyMaker(const Experiment& base, const StudyScope& scope) : base_(base), scope_(scope) {}

  PaperStudy Make() {
    Add(Figure::kField, 0, 0, "field", base_);
    for (int deployment = 1; deployment <= scope_.deployments; ++deployment) {
      for (const int radius : scope_.radii_cells) {
        AddDeployment(Figure::kRadius, radius, scope_.sensors_at_radii, radius, deployment);
      }
      for (const int sensors : scope_.sensor_counts) {
        AddDeployment(Figure::kSensors, sensors, sensors, scope_.radius_at_counts_cells, deployment);
      }
    }
    for (const Figure figure : {Figure::kEnergy, Figure::kEnergyDearFlight}) {
      for (const double share : scope_.budget_shares) {
        const double budget_j = BudgetOfShare(base_, figure, share);
        Add(figure, budget_j, 0,
            fmt::format("{}-{}j", figure == Figure::kEnergy ? "energy" : "dear-flight", budget_j),
            WithBudget(base_, figure, budget_j));
      }
    }
    return std::move(study_);
  }

 private:
  void AddDeployment(Figure figure, double x, int sensors, int radius_cells, int deployment) {
    Add(figure, x, deployment, fmt::format("n{}-r{}-d{}", sensors, radius_cells, deployment),
        WithDeployment(base_, sensors, radius_cells, deployment));
  }

  void Add(Figure figure, double x, int deployment, const std::string& name, const Experiment& experiment) {
    const auto same = std::find_if(study_.jobs.begin(), study_.jobs.end(),
                                   [&](const StudyJob& job) { return job.name == name; });
    study_.points.push_back({figure, x, deployment, static_cast<size_t>(same - study_.jobs.begin())});
    if (same == study_.jobs.end()) {
      study_.jobs.push_back({name, experiment});
    }
  }

  const Experiment& base_;
  const StudyScope& scope_;
  PaperStudy study_;
};

}  // namespace

PaperStudy MakePaperStudy(const Experiment& base, const StudyScope& scope) {
  RequireUavWorld(base.world(), "fresco figures");
  return StudyMaker(base, scope).Make();
}

Experiment WithBudget(const Experiment& base, Figure figure, double budget_j) {
  proto::ExperimentConfig config = base.config();
  if (figure == Figure::kEnergyDearFlight) {
    SetDearFlight(*config.mutable_scenario()->mutable_rotor());
  }
  config.mutable_scenario()->set_initial_energy_j(budget_j);
  return Experiment::Make(config, fmt::format("energy budget {} J", budget_j));
}

double BudgetOfShare(const Experiment& base, Figure figure, double share) {
  constexpr double kPlentyJ = 1e9;
  const Experiment experiment = WithBudget(base, figure, kPlentyJ);
  const UavWorld& world = RequireUavWorld(experiment.world(), "the figures");
  const int moves = world.longest_episode();
  const double least_j = CompletionEnergy(world, world.DistanceToStop(world.scenario().start), moves);
  const double most_j = moves * std::max(world.flying_energy_j(), world.hovering_energy_j());
  return std::ceil(least_j + share * (most_j - least_j));
}

}  // namespace fresco
