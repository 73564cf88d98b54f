// AVX2 and FMA (x86-64-v3).
#include <immintrin.h>

#include "nn/arithmetic_kernels.h"

namespace fresco {
namespace {

struct Lanes {
  static constexpr int kWidth = 8;
  static constexpr int kRegisters = 16;
  using Register = __m256;
  struct Part {
    explicit Part(int count)
        : mask(_mm256_cmpgt_epi32(_mm256_set1_epi32(count), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7))) {}
    __m256i mask;
  };
  static Register Load(const float* from) { return _mm256_loadu_ps(from); }
  static Register Load(const float* from, Part part) { return _mm256_maskload_ps(from, part.mask); }
  static void Store(float* to, Register value) { _mm256_storeu_ps(to, value); }
  static void Store(float* to, Register value, Part part) { _mm256_maskstore_ps(to, part.mask, value); }
  static Register Fill(float value) { return _mm256_set1_ps(value); }
  static Register MultiplyAdd(Register a, Register b, Register c) { return _mm256_fmadd_ps(a, b, c); }
  static Register KeepIfAboveZero(Register gate, Register value) {
    return _mm256_and_ps(_mm256_cmp_ps(gate, _mm256_setzero_ps(), _CMP_GT_OQ), value);
  }
};

}  // namespace
}  // namespace fresco

#include "nn/arithmetic_template.h"

namespace fresco {
const Arithmetic kArithmeticX86V3 = {"x86-64-v3", Multiply, AddScaled, StepAdam};
}
