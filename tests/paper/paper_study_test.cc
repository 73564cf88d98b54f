// Compares the runs of the figures with the paper's axes, and with energies worked out by hand.
#include "paper/paper_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "core/error.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

Experiment Base() {
  return Experiment::Parse("scenario { sensor { x_m: 200 y_m: 175 } } schedule { seed: 7 }", "the base");
}

const Scenario& ScenarioOfJob(const PaperStudy& study, const StudyPoint& point) {
  return RequireUavWorld(study.jobs[point.job].experiment.world(), "the test").scenario();
}

std::vector<StudyPoint> PointsOf(const PaperStudy& study, Figure figure) {
  std::vector<StudyPoint> points;
  std::copy_if(study.points.begin(), study.points.end(), std::back_inserter(points),
               [&](const StudyPoint& point) { return point.figure == figure; });
  return points;
}

TEST(PaperStudy, HasThePapersPointsForEveryDeployment) {
  StudyScope scope;
  scope.deployments = 4;
  const PaperStudy study = MakePaperStudy(Base(), scope);
  for (const auto& [figure, points] : {std::pair(Figure::kRadius, 6), std::pair(Figure::kSensors, 8)}) {
    std::set<std::pair<double, int>> seen;
    for (const StudyPoint& point : PointsOf(study, figure)) {
      seen.insert({point.x, point.deployment});
      const Scenario& scenario = ScenarioOfJob(study, point);
      const double radius_cells = figure == Figure::kRadius ? point.x : 4;
      const double sensors = figure == Figure::kSensors ? point.x : 3;
      EXPECT_EQ(scenario.coverage_radius_m, 25 * radius_cells);
      EXPECT_EQ(static_cast<double>(scenario.sensors.size()), sensors);
      EXPECT_EQ(study.jobs[point.job].experiment.schedule().seed(), 7u);
    }
    EXPECT_EQ(seen.size(), static_cast<size_t>(points) * 4);
    EXPECT_EQ(seen.begin()->first, 1);
    EXPECT_EQ(seen.rbegin()->first, points);
  }
}

TEST(PaperStudy, RunsAPointThatTwoFiguresShareOnce) {
  const PaperStudy study = MakePaperStudy(Base(), {});
  std::set<std::string> names;
  for (const StudyJob& job : study.jobs) {
    EXPECT_TRUE(names.insert(job.name).second) << job.name;
  }
  // 6 radii + 8 numbers of sensors - the shared N = 3, R = 4; the field; the budgets of both rotors.
  EXPECT_EQ(study.jobs.size(), 13u * 3 + 1 + 2 * StudyScope{}.budget_shares.size());
}

TEST(PaperStudy, GivesADeploymentTheSameSensorsAtEveryRadius) {
  const PaperStudy study = MakePaperStudy(Base(), {});
  std::map<int, std::set<double>> first_sensor_x_m;
  for (const StudyPoint& point : PointsOf(study, Figure::kRadius)) {
    first_sensor_x_m[point.deployment].insert(ScenarioOfJob(study, point).sensors[0].x_m);
  }
  std::set<double> different;
  for (const auto& [deployment, positions] : first_sensor_x_m) {
    EXPECT_EQ(positions.size(), 1u) << deployment;
    different.insert(*positions.begin());
  }
  EXPECT_EQ(different.size(), 3u);
}

TEST(PaperStudy, KeepsTheBaseAsItIsForTheField) {
  const PaperStudy study = MakePaperStudy(Base(), {});
  EXPECT_EQ(study.jobs.front().experiment.hash(), Base().hash());
  EXPECT_EQ(PointsOf(study, Figure::kField).size(), 1u);
}

// Table I: to fly in all 69 slots takes 69 * 112.876 W = 7788.4 J, the least. To hover in all of them would
// take 69 * 219.82 W = 15167.6 J, the most.
TEST(PaperStudy, SpansTheBudgetsFromTheLeastToTheMostThatAFlightCanUse) {
  EXPECT_EQ(BudgetOfShare(Base(), Figure::kEnergy, 0), 7789);
  EXPECT_EQ(BudgetOfShare(Base(), Figure::kEnergy, 1), 15168);
  // The literature's rotor: 19 flown at 248.97 W, 50 hovered at 168.49 W; all 69 flown.
  EXPECT_NEAR(BudgetOfShare(Base(), Figure::kEnergyDearFlight, 0), 19 * 248.97 + 50 * 168.49, 2);
  EXPECT_NEAR(BudgetOfShare(Base(), Figure::kEnergyDearFlight, 1), 69 * 248.97, 2);
}

TEST(PaperStudy, CanBeFlownOnTheLeastBudgetAndNotBelow) {
  for (const Figure figure : {Figure::kEnergy, Figure::kEnergyDearFlight}) {
    const double least_j = BudgetOfShare(Base(), figure, 0);
    EXPECT_NO_THROW(WithBudget(Base(), figure, least_j));
    EXPECT_THROW(WithBudget(Base(), figure, least_j - 1), Error);
  }
}

}  // namespace
}  // namespace fresco
