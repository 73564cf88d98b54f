// Sine and cosine for worlds. An episode must have the same bits on every host, but libraries of different
// hosts round these functions differently. These use only additions and multiplications, whose results IEEE
// 754 defines to the bit. Any thread may call them.
#pragma once

#include <bit>
#include <cstdint>

namespace fresco {

template <class Number>
struct SineAndCosine {
  Number sine;
  Number cosine;
};

// How many quarter turns a radian is, and pi / 2 in three parts, of which the first two have 33 bits.
inline constexpr double kQuartersPerRadian = 0x1.45f306dc9c883p-1;
inline constexpr double kHalfPi[] = {0x1.921fb544p0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};

/// The sine and the cosine of rest + lost, where |rest| is at most pi / 4 and `lost` is far smaller. `Number`
/// is double, or formulas of such numbers (worlds/formulas.h).
template <class Number>
SineAndCosine<Number> SineAndCosineOfRest(const Number& rest, const Number& lost) {
  // The minimax polynomials of fdlibm's __kernel_sin and __kernel_cos, in the order of evaluation of
  // FreeBSD's msun.
  const Number z = rest * rest;
  const Number w = z * z;
  const Number sine_tail = 8.33333333332248946124e-03 +
                           z * (-1.98412698298579493134e-04 + z * 2.75573137070700676789e-06) +
                           z * w * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
  const Number cube = z * rest;
  const Number sine =
      rest - ((z * (0.5 * lost - cube * sine_tail) - lost) - cube * -1.66666666666666324348e-01);
  const Number cosine_tail =
      z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * 2.48015872894767294178e-05)) +
      w * w *
          (-2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11));
  const Number half = 0.5 * z;
  const Number head = 1.0 - half;
  const Number cosine = head + (((1.0 - head) - half) + (z * cosine_tail - rest * lost));
  return {sine, cosine};
}

/// The sine and the cosine of an angle in radians, within 1.2 units in the last place if |angle| <= 1e5;
/// farther away they lose precision. NaN if the angle is not finite.
inline SineAndCosine<double> SineAndCosineOf(double angle) {
  // The angle is a number of quarter turns and a rest of at most an eighth turn. Adding `kRound` rounds to a
  // whole number, which is then the low bits. Quarter turns times each of the first two parts of pi / 2 are
  // exact, since these have 33 bits.
  constexpr double kEighth = 0x1.921fb54442d18p-1;  // pi / 4
  constexpr double kRound = 0x1.8p52;
  double shifted = kRound;
  double rest = angle;
  double lost = 0;  // what `rest` lacks
  if (!(angle >= -kEighth && angle <= kEighth)) {
    shifted += angle * kQuartersPerRadian;
    const double quarters = shifted - kRound;
    const double near = angle - quarters * kHalfPi[0];
    const double correction = quarters * kHalfPi[1];
    rest = near - correction;
    lost = (near - rest) - correction - quarters * kHalfPi[2];
  }

  const auto [sine, cosine] = SineAndCosineOfRest(rest, lost);
  const auto quarter = std::bit_cast<uint64_t>(shifted);
  const auto turned =
      quarter % 2 == 0 ? SineAndCosine<double>{sine, cosine} : SineAndCosine<double>{cosine, sine};
  return {(quarter & 2) == 0 ? turned.sine : -turned.sine,
          ((quarter + 1) & 2) == 0 ? turned.cosine : -turned.cosine};
}

}  // namespace fresco
