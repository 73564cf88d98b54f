// The arithmetic of networks, which is most of a training's time: products of matrices and steps of Adam, in
// single precision. Every number is defined to the bit, so it depends neither on the instruction set nor on
// how work is divided among calls and threads. Each instruction set has an implementation, in a source file
// of its own, which is compiled for processors that the rest of the program need not have. So this header
// includes nothing that has code. Whoever computes includes nn/arithmetic.h.
#pragma once

#include <cstdint>

namespace fresco {

/// What is done to the entries of a product at last.
enum class Finish : uint8_t {
  kNothing,
  kRelu,  ///< an entry that is not above 0 becomes 0
  kGate,  ///< an entry becomes 0 if `gate` is not above 0 in its place
};

/// result = finish(bias + a b). Entry (i, j) begins as bias(i, j), or 0 without a bias. Then, for k = 0, 1,
/// ..., it becomes fma(a(i, k), b(k, j), entry): a multiplication and an addition that are rounded together,
/// once. Matrices are column-major; a stride is the distance of two neighbouring columns, in entries. The
/// result must not overlap with the rest, but it may be the bias itself, which continues a product.
struct Product {
  int rows = 0;
  int columns = 0;
  int inner = 0;             ///< columns of a, rows of b; at least 1
  const float* a = nullptr;  ///< [rows x inner]
  int64_t a_stride = 0;
  const float* b = nullptr;  ///< b(k, j) is b[k * b_row_stride + j * b_stride]; one of the two is 1
  int64_t b_row_stride = 1;
  int64_t b_stride = 0;
  const float* bias = nullptr;  ///< [rows x columns], or null
  int64_t bias_stride = 0;      ///< 0: all columns have the same bias
  float* result = nullptr;      ///< [rows x columns]
  int64_t result_stride = 0;
  Finish finish = Finish::kNothing;
  const float* gate = nullptr;  ///< [rows x columns], for kGate
  int64_t gate_stride = 0;
};

/// The numbers of one step of Adam; see nn/adam.h.
struct AdamStep {
  float beta1 = 0;
  float beta2 = 0;
  float step_size = 0;  ///< with the correction of both moments' bias
  float epsilon = 0;    ///< with the correction of the second moment's bias
};

/// A moment nearer to 0 becomes 0. Otherwise the moments of a parameter whose gradient stays 0 would come to
/// the smallest numbers, with which processors are many times slower.
inline constexpr float kSmallestMoment = 0x1p-100f;

/// One implementation.
struct Arithmetic {
  const char* name;  ///< of the instruction set: "x86-64-v4", "x86-64-v3", "aarch64", "portable"

  void (*multiply)(const Product& product);

  /// y[i] = fma(factor, x[i], y[i]) for `count` entries.
  void (*add_scaled)(int count, float factor, const float* x, float* y);

  /// For each of `count` parameters p with gradient g: m = beta1 m + (1 - beta1) g; v = beta2 v + (1 - beta2)
  /// g^2; p = p - step_size m / (sqrt(v) + epsilon). Every operation is rounded by itself. See
  /// kSmallestMoment.
  void (*step)(const AdamStep& step, int64_t count, const float* gradient, float* first_moment,
               float* second_moment, float* parameters);
};

extern const Arithmetic kArithmeticX86V4;
extern const Arithmetic kArithmeticX86V3;
extern const Arithmetic kArithmeticAarch64;
extern const Arithmetic kArithmeticPortable;

}  // namespace fresco
