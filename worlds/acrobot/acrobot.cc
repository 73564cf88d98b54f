#include "worlds/acrobot/acrobot.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "worlds/episode.h"
#include "worlds/numeric_environment.h"
#include "worlds/trigonometry.h"

namespace fresco {
namespace {

StepResult AdvanceAcrobot(int action, Acrobot::State& state) {
  FRESCO_CHECK(action >= 0 && action <= 2);
  state = Acrobot::After(state, action - 1);
  const bool up = Acrobot::IsUp(state);
  return {up ? 0.0 : -1.0, up ? Ending::kTerminal : Ending::kNone};
}

WorldDescription DescribeAcrobot(int maximum_steps) {
  WorldDescription description;
  description.name = "acrobot";
  description.state = {{"angle_1", "rad"},
                       {"angle_2", "rad"},
                       {"angular_velocity_1", "rad/s"},
                       {"angular_velocity_2", "rad/s"}};
  description.actions = {"torque -1", "no torque", "torque +1"};
  description.observation_size = 6;
  description.longest_episode = maximum_steps;
  description.discount = 0.99;
  description.chance = false;
  description.copies = true;
  description.figures = {{"return", ""}};
  description.success = "swung_up";
  return description;
}

// The derivative of the state. The names d1, d2, phi1 and phi2 are the book's.
Acrobot::State AcrobotRates(const Acrobot::State& state, double torque_nm) {
  // Both links are alike.
  constexpr double kMassKg = 1;
  constexpr double kLengthM = 1;
  constexpr double kCentreM = 0.5;  // of mass, from the upper end
  constexpr double kInertia = 1;    // kg m^2
  constexpr double kGravity = 9.8;  // m/s^2
  constexpr double kCoupling = kMassKg * kLengthM * kCentreM;
  const auto [angle1, angle2, velocity1, velocity2] = state;
  const auto [sine2, cosine2] = SineAndCosineOf(angle2);
  const double d1 = kMassKg * kCentreM * kCentreM + kMassKg * (kLengthM * kLengthM + kCentreM * kCentreM) +
                    2 * kCoupling * cosine2 + 2 * kInertia;
  const double d2 = kMassKg * kCentreM * kCentreM + kCoupling * cosine2 + kInertia;
  const double phi2 = kMassKg * kCentreM * kGravity * SineAndCosineOf(angle1 + angle2).sine;
  const double phi1 = -kCoupling * velocity2 * (velocity2 + 2 * velocity1) * sine2 +
                      kMassKg * (kCentreM + kLengthM) * kGravity * SineAndCosineOf(angle1).sine + phi2;
  const double acceleration2 =
      (torque_nm + d2 / d1 * phi1 - kCoupling * velocity1 * velocity1 * sine2 - phi2) /
      (kMassKg * kCentreM * kCentreM + kInertia - d2 * d2 / d1);
  const double acceleration1 = -(d2 * acceleration2 + phi1) / d1;
  return {velocity1, velocity2, acceleration1, acceleration2};
}

Acrobot::State Advance(Acrobot::State state, const Acrobot::State& rates, double seconds) {
  for (size_t field = 0; field < state.size(); ++field) {
    state[field] += seconds * rates[field];
  }
  return state;
}

/// SineAndCosineOf as formulas.
SineAndCosine<Term> FormulasOfSineAndCosine(Term angles) {
  const Term quarters = RoundToWhole(angles * kQuartersPerRadian);
  const Term near = angles - quarters * kHalfPi[0];
  const Term correction = quarters * kHalfPi[1];
  const Term rest = near - correction;
  const Term lost = (near - rest) - correction - quarters * kHalfPi[2];
  const auto [sine, cosine] = SineAndCosineOfRest(rest, lost);
  const auto is_odd = [](Term number) { return number - 2.0 * Floor(number / 2.0); };
  const auto turned = [&](Term turns, Term even, Term odd) {
    const Term value = Choose(is_odd(turns), odd, even);
    return Choose(is_odd(Floor(turns / 2.0)), -value, value);
  };
  return {turned(quarters, sine, cosine), turned(quarters + 1.0, sine, cosine)};
}

}  // namespace

Acrobot::Acrobot(int maximum_steps) : World(DescribeAcrobot(maximum_steps)) {}

std::unique_ptr<Environment> Acrobot::NewEnvironment() const {
  return std::make_unique<NumericEnvironment<4, AdvanceAcrobot>>(0.1, longest_episode());
}

void Acrobot::Observe(std::span<const float> state, std::span<float> observation) const {
  FRESCO_CHECK(state.size() == 4 && observation.size() == 6);
  for (size_t link = 0; link < 2; ++link) {
    const auto [sine, cosine] = SineAndCosineOf(state[link]);
    observation[2 * link] = static_cast<float>(cosine);
    observation[2 * link + 1] = static_cast<float>(sine);
  }
  observation[4] = static_cast<float>(state[2] / kMaximumVelocity1);
  observation[5] = static_cast<float>(state[3] / kMaximumVelocity2);
}

std::optional<StateFormulas> Acrobot::Formulate(Formulas& formulas) const {
  const auto [sines, cosines] = FormulasOfSineAndCosine(ToDouble(formulas.State(0, 2)));
  const Term velocities =
      ToDouble(formulas.State(2, 2)) / formulas.Double({kMaximumVelocity1, kMaximumVelocity2});
  const Term observation = formulas.Join(
      {Part(cosines, 0, 1), Part(sines, 0, 1), Part(cosines, 1, 1), Part(sines, 1, 1), velocities});
  return StateFormulas{ToSingle(observation), formulas.Single({1, 1, 1})};
}

bool Acrobot::Succeeded(const Episode& episode) const {
  return episode.ending == Ending::kTerminal;
}

Acrobot::State Acrobot::After(const State& state, double torque_nm) {
  constexpr double kStepS = 0.2;
  const State k1 = AcrobotRates(state, torque_nm);
  const State k2 = AcrobotRates(Advance(state, k1, kStepS / 2), torque_nm);
  const State k3 = AcrobotRates(Advance(state, k2, kStepS / 2), torque_nm);
  const State k4 = AcrobotRates(Advance(state, k3, kStepS), torque_nm);
  State next = state;
  for (size_t field = 0; field < next.size(); ++field) {
    next[field] += kStepS / 6 * (k1[field] + 2 * k2[field] + 2 * k3[field] + k4[field]);
  }
  return {std::remainder(next[0], 2 * std::numbers::pi), std::remainder(next[1], 2 * std::numbers::pi),
          std::clamp(next[2], -kMaximumVelocity1, kMaximumVelocity1),
          std::clamp(next[3], -kMaximumVelocity2, kMaximumVelocity2)};
}

bool Acrobot::IsUp(const State& state) {
  return -SineAndCosineOf(state[0]).cosine - SineAndCosineOf(state[0] + state[1]).cosine > 1;
}

}  // namespace fresco
