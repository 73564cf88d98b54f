// NEON, which every 64-bit ARM processor has.
#include <arm_neon.h>

#include "nn/arithmetic_kernels.h"

namespace fresco {
namespace {

struct Lanes {
  static constexpr int kWidth = 4;
  static constexpr int kRegisters = 32;
  using Register = float32x4_t;
  struct Part {
    explicit Part(int first_lanes) : count(first_lanes) {}
    int count;
  };
  static Register Load(const float* from) { return vld1q_f32(from); }
  static Register Load(const float* from, Part part) {
    float values[kWidth] = {};
    for (int i = 0; i < part.count; ++i) {
      values[i] = from[i];
    }
    return vld1q_f32(values);
  }
  static void Store(float* to, Register value) { vst1q_f32(to, value); }
  static void Store(float* to, Register value, Part part) {
    float values[kWidth];
    vst1q_f32(values, value);
    for (int i = 0; i < part.count; ++i) {
      to[i] = values[i];
    }
  }
  static Register Fill(float value) { return vdupq_n_f32(value); }
  static Register MultiplyAdd(Register a, Register b, Register c) { return vfmaq_f32(c, a, b); }
  static Register KeepIfAboveZero(Register gate, Register value) {
    return vreinterpretq_f32_u32(vandq_u32(vcgtzq_f32(gate), vreinterpretq_u32_f32(value)));
  }
};

}  // namespace
}  // namespace fresco

#include "nn/arithmetic_template.h"

namespace fresco {
const Arithmetic kArithmeticAarch64 = {"aarch64", Multiply, AddScaled, StepAdam};
}
