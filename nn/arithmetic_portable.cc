// For every processor, also for those that can't multiply and add in one operation. The vectors are those of
// gcc and clang.
#include "nn/arithmetic_kernels.h"

namespace fresco {
namespace {

using Floats = float __attribute__((vector_size(16)));
using Words = uint32_t __attribute__((vector_size(16)));  // as many as Floats
using Integers = int32_t __attribute__((vector_size(16)));
using Doubles = double __attribute__((vector_size(16)));
using Longs = int64_t __attribute__((vector_size(16)));  // as many as Doubles
using FourDoubles = double __attribute__((vector_size(32)));

/// product + addend, rounded to an odd number if it is not exact (Boldo and Melquiond, "Emulation of FMA and
/// correctly rounded sums: proved algorithms using rounding to odd", 2008). So a second rounding, to single
/// precision, gives what one rounding would have given.
Doubles SumRoundedToOdd(Doubles product, Doubles addend) {
  const Doubles sum = product + addend;
  const Doubles rest = sum - product;
  const Doubles error = (product - (sum - rest)) + (addend - rest);  // what the sum lacks, exactly
  const Longs inexact = (error > 0) | (error < 0);
  const Longs too_far =
      ((reinterpret_cast<Longs>(error) ^ reinterpret_cast<Longs>(sum)) < 0) & inexact;  // -1
  return reinterpret_cast<Doubles>((reinterpret_cast<Longs>(sum) + too_far) | (inexact & 1));
}

struct Lanes {
  static constexpr int kWidth = 4;
  static constexpr int kRegisters = 16;
  /// Numbers of single precision.
  struct Register {
    Doubles low;
    Doubles high;
  };
  struct Part {
    explicit Part(int first_lanes) : count(first_lanes) {}
    int count;
  };
  static Register Load(const float* from) {
    Floats values;
    __builtin_memcpy(&values, from, sizeof(values));
    return Widen(values);
  }
  static Register Load(const float* from, Part part) {
    Floats values = {};
    for (int i = 0; i < part.count; ++i) {
      values[i] = from[i];
    }
    return Widen(values);
  }
  static void Store(float* to, Register numbers) {
    const Floats values = Round(numbers);
    __builtin_memcpy(to, &values, sizeof(values));
  }
  static void Store(float* to, Register numbers, Part part) {
    const Floats values = Round(numbers);
    for (int i = 0; i < part.count; ++i) {
      to[i] = values[i];
    }
  }
  static Register Fill(float value) {
    const auto number = static_cast<double>(value);
    const Doubles both = {number, number};
    return {both, both};
  }

  /// The products are exact in double precision. The sums are rounded twice, to double and to single
  /// precision. That can differ from one rounding only if a sum lies in the middle of two floats, or if the
  /// result has fewer bits than usual since it is nearly zero.
  static Register MultiplyAdd(Register a, Register b, Register c) {
    constexpr uint32_t kSignBit = 0x80000000u;
    constexpr uint32_t kTwiceLeastNormal = 0x01000000u;  // the bits of 2^-126 without the sign's
    const Doubles low = a.low * b.low;
    const Doubles high = a.high * b.high;
    const Register sum = {low + c.low, high + c.high};
    const Floats rounded = Round(sum);
    const Words last_bits = __builtin_shufflevector(reinterpret_cast<Words>(sum.low),
                                                    reinterpret_cast<Words>(sum.high), 0, 2, 4, 6);
    const Integers in_the_middle =
        (last_bits << 3) == kSignBit;  // of the last 29 bits, only the first is set
    // Moved by half the range, so that signed numbers, which SSE2 compares, have the order of unsigned ones.
    const Words moved = (reinterpret_cast<Words>(rounded) << 1) - 1 + kSignBit;
    const Words limit = Words{} + (kTwiceLeastNormal + kSignBit);
    const Integers nearly_zero = reinterpret_cast<Integers>(moved) < reinterpret_cast<Integers>(limit);
    const auto doubtful = reinterpret_cast<Longs>(in_the_middle | nearly_zero);
    if ((doubtful[0] | doubtful[1]) != 0) [[unlikely]] {
      return Widen(Round({SumRoundedToOdd(low, c.low), SumRoundedToOdd(high, c.high)}));
    }
    return Widen(rounded);
  }

  static Register KeepIfAboveZero(Register gate, Register value) {
    return {reinterpret_cast<Doubles>(reinterpret_cast<Longs>(value.low) & (gate.low > 0)),
            reinterpret_cast<Doubles>(reinterpret_cast<Longs>(value.high) & (gate.high > 0))};
  }

 private:
  static Register Widen(Floats values) {
    const FourDoubles numbers = __builtin_convertvector(values, FourDoubles);
    return {__builtin_shufflevector(numbers, numbers, 0, 1), __builtin_shufflevector(numbers, numbers, 2, 3)};
  }
  static Floats Round(Register numbers) {
    const FourDoubles all = __builtin_shufflevector(numbers.low, numbers.high, 0, 1, 2, 3);
    return __builtin_convertvector(all, Floats);
  }
};

}  // namespace
}  // namespace fresco

#include "nn/arithmetic_template.h"

namespace fresco {
const Arithmetic kArithmeticPortable = {"portable", Multiply, AddScaled, StepAdam};
}
