// AVX-512 (x86-64-v4).
#include <immintrin.h>

#include "nn/arithmetic_kernels.h"

namespace fresco {
namespace {

struct Lanes {
  static constexpr int kWidth = 16;
  static constexpr int kRegisters = 32;
  using Register = __m512;
  struct Part {
    explicit Part(int count) : mask(static_cast<__mmask16>((1u << count) - 1)) {}
    __mmask16 mask;
  };
  static Register Load(const float* from) { return _mm512_loadu_ps(from); }
  static Register Load(const float* from, Part part) { return _mm512_maskz_loadu_ps(part.mask, from); }
  static void Store(float* to, Register value) { _mm512_storeu_ps(to, value); }
  static void Store(float* to, Register value, Part part) { _mm512_mask_storeu_ps(to, part.mask, value); }
  static Register Fill(float value) { return _mm512_set1_ps(value); }
  static Register MultiplyAdd(Register a, Register b, Register c) { return _mm512_fmadd_ps(a, b, c); }
  static Register KeepIfAboveZero(Register gate, Register value) {
    return _mm512_maskz_mov_ps(_mm512_cmp_ps_mask(gate, _mm512_setzero_ps(), _CMP_GT_OQ), value);
  }
};

}  // namespace
}  // namespace fresco

#include "nn/arithmetic_template.h"

namespace fresco {
const Arithmetic kArithmeticX86V4 = {"x86-64-v4", Multiply, AddScaled, StepAdam};
}
