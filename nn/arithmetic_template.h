// The implementation of nn/arithmetic.h for registers of any width. A source file defines `Lanes`, the
// registers of its instruction set, in namespace fresco::FRESCO_ARITHMETIC and includes this. Everything has
// internal linkage, so that no other part of the program gets code for these instructions.
//
// Lanes has: kWidth; kRegisters, of the instruction set; Register; Part (made from a count below kWidth: the
// first so many lanes); Load(p), Load(p, part), Store(p, r), Store(p, r, part), Fill(x), MultiplyAdd(a, b,
// c): a b + c, KeepIfAboveZero(gate, r).

namespace fresco {
namespace {

// Accumulators, registers of a and one value of b must fit into the registers.
constexpr int kAccumulators = Lanes::kRegisters >= 32 ? 24 : 12;

// How many values of k are asked of the memory ahead of time.
constexpr int kAhead = 8;

/// The registers of a column that a tile of so many columns has.
constexpr int HeightFor(int columns) {
  return kAccumulators / columns < 8 ? kAccumulators / columns : 8;
}

/// A block of the result, of kHeight registers in each of kColumns columns, is computed in registers. If
/// kWhole is false, the last register of each column has only the lanes of `part`.
template <int kHeight, int kColumns, bool kNeighbours, bool kWhole>
inline __attribute__((always_inline)) void MultiplyTile(const Product& product, int row, int column,
                                                        Lanes::Part part) {
  using Register = Lanes::Register;
  constexpr int kWidth = Lanes::kWidth;
  Register sums[kHeight][kColumns];
  const auto load = [&](const float* from, int height) __attribute__((always_inline)) {
    return kWhole || height + 1 < kHeight ? Lanes::Load(from + height * kWidth)
                                          : Lanes::Load(from + height * kWidth, part);
  };
#pragma GCC unroll 8
  for (int height = 0; height < kHeight; ++height) {
    const Register first = product.bias != nullptr ? load(product.bias + row, height) : Lanes::Fill(0);
#pragma GCC unroll 8
    for (int i = 0; i < kColumns; ++i) {
      sums[height][i] = first;
    }
  }
  if (product.bias_stride != 0) {
#pragma GCC unroll 8
    for (int i = 0; i < kColumns; ++i) {
#pragma GCC unroll 8
      for (int height = 0; height < kHeight; ++height) {
        sums[height][i] = load(product.bias + (column + i) * product.bias_stride + row, height);
      }
    }
  }
  const float* a = product.a + row;
  const float* b = product.b + column * product.b_stride;
  // One of the strides is 1, which the compiler shall know.
  const int64_t down = kNeighbours ? product.b_row_stride : 1;
  const int64_t across = kNeighbours ? 1 : product.b_stride;
  for (int k = 0; k < product.inner; ++k) {
    if constexpr (kNeighbours) {  // then neither a nor b is in the nearest cache, and the strides are long
      __builtin_prefetch(b + kAhead * down);
#pragma GCC unroll 8
      for (int height = 0; height < kHeight; ++height) {
        __builtin_prefetch(a + kAhead * product.a_stride + height * kWidth);
      }
    }
    Register lanes[kHeight];
#pragma GCC unroll 8
    for (int height = 0; height < kHeight; ++height) {
      lanes[height] = load(a, height);
    }
#pragma GCC unroll 8
    for (int i = 0; i < kColumns; ++i) {
      const Register value = Lanes::Fill(b[i * across]);
#pragma GCC unroll 8
      for (int height = 0; height < kHeight; ++height) {
        sums[height][i] = Lanes::MultiplyAdd(lanes[height], value, sums[height][i]);
      }
    }
    a += product.a_stride;
    b += down;
  }
#pragma GCC unroll 8
  for (int i = 0; i < kColumns; ++i) {
    float* result = product.result + (column + i) * product.result_stride + row;
#pragma GCC unroll 8
    for (int height = 0; height < kHeight; ++height) {
      Register sum = sums[height][i];
      if (product.finish == Finish::kRelu) {
        sum = Lanes::KeepIfAboveZero(sum, sum);
      } else if (product.finish == Finish::kGate) {
        const float* gate = product.gate + (column + i) * product.gate_stride + row;
        sum = Lanes::KeepIfAboveZero(load(gate, height), sum);
      }
      if (kWhole || height + 1 < kHeight) {
        Lanes::Store(result + height * kWidth, sum);
      } else {
        Lanes::Store(result + height * kWidth, sum, part);
      }
    }
  }
}

/// The rows from `row` on, in tiles of kHeight registers, for the columns from `first` to before `end`, a
/// multiple of kColumns. Returns the first row that is left: fewer are left than a tile has.
template <int kHeight, int kColumns, bool kNeighbours>
int MultiplyRows(const Product& product, int row, int first, int end) {
  constexpr int kRows = kHeight * Lanes::kWidth;
  for (; row + kRows <= product.rows; row += kRows) {
    for (int column = first; column < end; column += kColumns) {
      MultiplyTile<kHeight, kColumns, kNeighbours, true>(product, row, column, Lanes::Part(0));
    }
  }
  const int left = product.rows - row;
  if (left > kRows - Lanes::kWidth) {  // all registers but a part of the last one
    for (int column = first; column < end; column += kColumns) {
      MultiplyTile<kHeight, kColumns, kNeighbours, false>(product, row, column,
                                                          Lanes::Part(left % Lanes::kWidth));
    }
    row = product.rows;
  }
  return row;
}

template <int kColumns, bool kNeighbours>
void MultiplyColumns(const Product& product, int first, int end) {
  constexpr int kHeight = HeightFor(kColumns);
  int row = MultiplyRows<kHeight, kColumns, kNeighbours>(product, 0, first, end);
  if constexpr (kHeight > 4) {
    row = MultiplyRows<4, kColumns, kNeighbours>(product, row, first, end);
  }
  if constexpr (kHeight > 2) {
    row = MultiplyRows<2, kColumns, kNeighbours>(product, row, first, end);
  }
  MultiplyRows<1, kColumns, kNeighbours>(product, row, first, end);
}

template <bool kNeighbours>
void MultiplyWith(const Product& product) {
  constexpr int kWidest = kAccumulators / 3;
  const int wide = product.columns / kWidest * kWidest;
  MultiplyColumns<kWidest, kNeighbours>(product, 0, wide);
  int column = wide;
  if constexpr (kWidest > 4) {
    const int end = column + (product.columns - column) / 4 * 4;
    MultiplyColumns<4, kNeighbours>(product, column, end);
    column = end;
  }
  const int pairs = column + (product.columns - column) / 2 * 2;
  MultiplyColumns<2, kNeighbours>(product, column, pairs);
  MultiplyColumns<1, kNeighbours>(product, pairs, product.columns);
}

void Multiply(const Product& product) {
  if (product.b_row_stride == 1) {
    MultiplyWith<false>(product);
  } else {
    MultiplyWith<true>(product);
  }
}

void AddScaled(int count, float factor, const float* __restrict x, float* __restrict y) {
  constexpr int kWidth = Lanes::kWidth;
  const Lanes::Register factors = Lanes::Fill(factor);
  int i = 0;
  for (; i + kWidth <= count; i += kWidth) {
    Lanes::Store(y + i, Lanes::MultiplyAdd(factors, Lanes::Load(x + i), Lanes::Load(y + i)));
  }
  if (i < count) {
    const Lanes::Part part(count - i);
    Lanes::Store(y + i, Lanes::MultiplyAdd(factors, Lanes::Load(x + i, part), Lanes::Load(y + i, part)),
                 part);
  }
}

float WithoutTiny(float moment) {
  return __builtin_fabsf(moment) < kSmallestMoment ? 0 : moment;
}

void StepAdam(const AdamStep& step, int64_t count, const float* __restrict g, float* __restrict m,
              float* __restrict v, float* __restrict p) {
  for (int64_t i = 0; i < count; ++i) {
    m[i] = WithoutTiny(step.beta1 * m[i] + (1 - step.beta1) * g[i]);
    v[i] = WithoutTiny(step.beta2 * v[i] + (1 - step.beta2) * (g[i] * g[i]));
    p[i] -= step.step_size * m[i] / (__builtin_sqrtf(v[i]) + step.epsilon);
  }
}

}  // namespace
}  // namespace fresco
