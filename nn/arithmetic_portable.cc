// Plain C++ for every processor, also for those that can't multiply and add in one operation.
#include "nn/arithmetic_kernels.h"

namespace fresco {
namespace {

/// fma(a, b, c). The product is exact in double precision. If the sum is not, it is rounded to an odd number
/// (Boldo and Melquiond, "Emulation of FMA and correctly rounded sums: proved algorithms using rounding to
/// odd", 2008). So the second rounding, to single precision, gives what one rounding would have given.
float FusedMultiplyAdd(float a, float b, float c) {
  const double product = static_cast<double>(a) * static_cast<double>(b);
  const double addend = static_cast<double>(c);
  double sum = product + addend;
  const double rest = sum - product;
  const double error = (product - (sum - rest)) + (addend - rest);  // what the sum lacks, exactly
  if (error > 0 || error < 0) {
    int64_t bits = 0;
    __builtin_memcpy(&bits, &sum, sizeof(bits));
    if ((bits & 1) == 0) {
      bits += (error > 0) == (sum > 0) ? 1 : -1;
      __builtin_memcpy(&sum, &bits, sizeof(bits));
    }
  }
  return static_cast<float>(sum);
}

struct Lanes {
  static constexpr int kWidth = 1;
  static constexpr int kRegisters = 16;
  using Register = float;
  struct Part {
    explicit Part(int) {}
  };
  static Register Load(const float* from) { return *from; }
  static Register Load(const float*, Part) { return 0; }
  static void Store(float* to, Register value) { *to = value; }
  static void Store(float*, Register, Part) {}
  static Register Fill(float value) { return value; }
  static Register MultiplyAdd(Register a, Register b, Register c) { return FusedMultiplyAdd(a, b, c); }
  static Register KeepIfAboveZero(Register gate, Register value) { return gate > 0 ? value : 0; }
};

}  // namespace
}  // namespace fresco

#include "nn/arithmetic_template.h"

namespace fresco {
const Arithmetic kArithmeticPortable = {"portable", Multiply, AddScaled, StepAdam};
}
