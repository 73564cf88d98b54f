// Every implementation of the arithmetic that this processor has against its definition: loops of std::fma,
// which the C standard defines. They have to agree to the bit.
#include "nn/arithmetic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

class ArithmeticTest : public ::testing::TestWithParam<const Arithmetic*> {
 protected:
  const Arithmetic& arithmetic() const { return *GetParam(); }
  RandomStream stream_{1, RandomPurpose::kTest, 0, 0};
};

std::string Name(const ::testing::TestParamInfo<const Arithmetic*>& info) {
  std::string name = info.param->name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

/// Numbers of very different sizes, zeros of both signs among them.
std::vector<float> WideFloats(RandomStream& stream, int64_t count) {
  std::vector<float> values = RandomFloats(stream, static_cast<size_t>(count), 1);
  for (float& value : values) {
    const uint32_t kind = stream.NextBelow(20);
    value = kind == 0 ? 0.0f : kind == 1 ? -0.0f : std::ldexp(value, static_cast<int>(kind) - 10);
  }
  return values;
}

struct Shape {
  int rows, columns, inner;
};

/// The operands of a product, with strides that are longer than the columns.
struct Operands {
  Operands(Shape shape, bool neighbours, RandomStream& stream) {
    constexpr int kLonger = 3;
    product.rows = shape.rows;
    product.columns = shape.columns;
    product.inner = shape.inner;
    product.a_stride = product.result_stride = product.gate_stride = shape.rows + kLonger;
    product.b_row_stride = neighbours ? shape.columns + kLonger : 1;
    product.b_stride = neighbours ? 1 : shape.inner + kLonger;
    a = WideFloats(stream, product.a_stride * shape.inner);
    b = WideFloats(stream, int64_t{shape.inner + kLonger} * (shape.columns + kLonger));
    bias = WideFloats(stream, shape.rows);
    gate = WideFloats(stream, product.gate_stride * shape.columns);
    result.assign(static_cast<size_t>(product.result_stride * shape.columns), kUntouched);
    product.a = a.data();
    product.b = b.data();
    product.result = result.data();
    product.gate = gate.data();
  }
  static constexpr float kUntouched = 12345.0f;
  std::vector<float> a, b, bias, gate, result;
  Product product;
};

float Entry(const Product& product, int row, int column) {
  float entry = product.bias != nullptr ? product.bias[row] : 0.0f;
  for (int k = 0; k < product.inner; ++k) {
    entry = std::fma(product.a[k * product.a_stride + row],
                     product.b[k * product.b_row_stride + column * product.b_stride], entry);
  }
  const bool keeps =
      product.finish == Finish::kNothing ||
      (product.finish == Finish::kRelu ? entry : product.gate[column * product.gate_stride + row]) > 0;
  return keeps ? entry : 0.0f;
}

uint32_t BitsOf(float value) {
  uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

void ExpectDefinedResult(const Operands& operands) {
  const Product& product = operands.product;
  for (int column = 0; column < product.columns; ++column) {
    for (int row = 0; row < product.result_stride; ++row) {
      const float expected = row < product.rows ? Entry(product, row, column) : Operands::kUntouched;
      const float found = operands.result[static_cast<size_t>(column * product.result_stride + row)];
      ASSERT_EQ(BitsOf(found), BitsOf(expected)) << product.rows << " x " << product.columns << " x "
                                                 << product.inner << ": (" << row << ", " << column << ")";
    }
  }
}

TEST_P(ArithmeticTest, ProductsHaveTheBitsOfTheirDefinition) {
  std::vector<Shape> shapes = {{200, 40, 7}, {20, 9, 256}, {100, 13, 30}};
  for (int rows = 1; rows <= 70; ++rows) {
    shapes.push_back({rows, 1 + rows % 11, 1 + rows % 5});
  }
  for (int columns = 1; columns <= 20; ++columns) {
    shapes.push_back({17, columns, 3});
    shapes.push_back({150, columns, 2});
  }
  for (const Shape& shape : shapes) {
    for (const bool neighbours : {false, true}) {
      for (const Finish finish : {Finish::kNothing, Finish::kRelu, Finish::kGate}) {
        Operands operands(shape, neighbours, stream_);
        operands.product.bias = finish == Finish::kGate ? nullptr : operands.bias.data();
        operands.product.finish = finish;
        arithmetic().multiply(operands.product);
        ExpectDefinedResult(operands);
      }
    }
  }
}

TEST_P(ArithmeticTest, AProductThatIsContinuedInPlaceHasTheBitsOfOneProduct) {
  for (const bool neighbours : {false, true}) {
    for (int size = 1; size <= 70; ++size) {
      Operands operands({size, 1 + size % 13, 2 + size % 9}, neighbours, stream_);
      Product product = operands.product;
      product.bias = operands.bias.data();
      product.inner = 1 + size % (operands.product.inner - 1);
      arithmetic().multiply(product);
      product.a += product.inner * product.a_stride;
      product.b += product.inner * product.b_row_stride;
      product.inner = operands.product.inner - product.inner;
      product.bias = product.result;
      product.bias_stride = product.result_stride;
      product.finish = Finish::kRelu;
      arithmetic().multiply(product);
      operands.product.bias = operands.bias.data();
      operands.product.finish = Finish::kRelu;
      ExpectDefinedResult(operands);
    }
  }
}

TEST_P(ArithmeticTest, RoundsEachMultiplicationAndAdditionOnce) {
  // The exact sum lies just beside the middle of two floats, by less than a double can show.
  constexpr float kOne = 1.0f;
  const float half_of_last = std::ldexp(1.0f, -24);
  const float tiny = std::ldexp(1.0f, -70);
  const float least = std::numeric_limits<float>::denorm_min();
  const float largest = std::numeric_limits<float>::max();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<std::array<float, 3>> cases = {
      {half_of_last, kOne + std::ldexp(1.0f, -23), kOne},
      {half_of_last, kOne, kOne},
      {half_of_last, -kOne, kOne},
      {std::ldexp(1.0f, -12) + std::ldexp(1.0f, -35), std::ldexp(1.0f, -12), kOne},
      {std::ldexp(1.0f, -12) - std::ldexp(1.0f, -36), std::ldexp(1.0f, -12), kOne},
      {tiny, tiny, kOne},
      {-tiny, tiny, kOne},
      {least, kOne, least},
      {least, 0.5f, least},
      {least, 0.5f, 3 * least},
      {largest, 2.0f, -largest},
      {largest, largest, -infinity},
      {largest, 1.0f, largest},
      {0.0f, -1.0f, 0.0f},
      {0.0f, -1.0f, -0.0f},
      {infinity, 1.0f, 1.0f}};
  for (const auto& [a, b, c] : cases) {
    float sum = c;
    arithmetic().add_scaled(1, a, &b, &sum);
    EXPECT_EQ(BitsOf(sum), BitsOf(std::fma(a, b, c))) << a << " " << b << " " << c;
  }
}

TEST_P(ArithmeticTest, RoundsSumsNearTheMiddleOfTwoFloatsOnce) {
  // The product is half of the sum's last bit but for a last bit of its factors. Its size goes down to where
  // floats have fewer bits.
  for (const int exponent : {0, -100, -124, -125, -126, -130}) {
    const float even = std::ldexp(1.0f, exponent);
    const float odd = std::nextafter(even, 1.0f);
    for (int bit = 1; bit <= 48; ++bit) {
      for (int other_bit = 1; other_bit <= 24; ++other_bit) {
        const float factor = std::ldexp(1.0f, -12) * (1 + std::ldexp(bit % 2 == 0 ? 1.0f : -1.0f, -bit / 2));
        const float other = std::ldexp(1.0f, exponent - 12) * (1 + std::ldexp(1.0f, -other_bit));
        const std::vector<float> x = {other, -other, other, -other, std::ldexp(other, -40)};
        std::vector<float> sums = {even, even, odd, odd, 0.0f};
        std::vector<float> expected = sums;
        for (size_t i = 0; i < x.size(); ++i) {
          expected[i] = std::fma(factor, x[i], expected[i]);
        }
        arithmetic().add_scaled(static_cast<int>(x.size()), factor, x.data(), sums.data());
        ASSERT_EQ(sums, expected) << exponent << " " << bit << " " << other_bit;
      }
    }
  }
}

TEST_P(ArithmeticTest, AddsScaledVectorsOfEveryLength) {
  for (int count = 0; count <= 70; ++count) {
    const std::vector<float> x = WideFloats(stream_, count + 1);
    std::vector<float> y = WideFloats(stream_, count + 1);
    std::vector<float> expected = y;
    const float factor = static_cast<float>(stream_.NextUniform());
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
      expected[i] = std::fma(factor, x[i], expected[i]);
    }
    arithmetic().add_scaled(count, factor, x.data(), y.data());
    EXPECT_EQ(y, expected) << count;
  }
}

TEST_P(ArithmeticTest, StepsOfAdamRoundEveryOperation) {
  constexpr AdamStep kStep = {0.9f, 0.999f, 1e-3f, 1e-8f};
  for (int count = 0; count <= 40; ++count) {
    const std::vector<float> gradient = WideFloats(stream_, count);
    std::vector<float> first = WideFloats(stream_, count);
    std::vector<float> second = WideFloats(stream_, count);
    std::vector<float> parameters = WideFloats(stream_, count);
    std::transform(second.begin(), second.end(), second.begin(), [](float v) { return std::abs(v); });
    std::vector<float> m = first, v = second, p = parameters;
    for (size_t i = 0; i < gradient.size(); ++i) {
      // Volatile, so that this compiler can't put two operations together either.
      volatile float a = kStep.beta1 * m[i];
      volatile float b = (1 - kStep.beta1) * gradient[i];
      m[i] = a + b;
      m[i] = std::abs(m[i]) < kSmallestMoment ? 0 : m[i];
      a = kStep.beta2 * v[i];
      b = gradient[i] * gradient[i];
      b = (1 - kStep.beta2) * b;
      v[i] = a + b;
      v[i] = v[i] < kSmallestMoment ? 0 : v[i];
      a = kStep.step_size * m[i];
      b = std::sqrt(v[i]);
      b = b + kStep.epsilon;
      a = a / b;
      p[i] = p[i] - a;
    }
    arithmetic().step(kStep, count, gradient.data(), first.data(), second.data(), parameters.data());
    EXPECT_EQ(first, m) << count;
    EXPECT_EQ(second, v) << count;
    EXPECT_EQ(parameters, p) << count;
  }
}

// A dead unit's parameters: their gradient stays 0, and so their moments shrink at every step.
TEST_P(ArithmeticTest, MomentsThatFadeBecomeZeroBeforeTheyAreSlow) {
  constexpr AdamStep kStep = {0.9f, 0.9f, 1e-3f, 1e-8f};
  constexpr int kCount = 40;
  const std::vector<float> gradient(kCount, 0.0f);
  std::vector<float> first(kCount, -1.0f);
  std::vector<float> second(kCount, 1.0f);
  std::vector<float> parameters(kCount, 1.0f);
  constexpr int kStepsToFade = 700;  // 0.9^700 is 2^-106
  for (int i = 0; i < kStepsToFade; ++i) {
    arithmetic().step(kStep, kCount, gradient.data(), first.data(), second.data(), parameters.data());
    for (const float moment : {first[0], first[kCount - 1], second[0], second[kCount - 1]}) {
      ASSERT_NE(std::fpclassify(moment), FP_SUBNORMAL) << i;
    }
  }
  EXPECT_EQ(first, gradient);
  EXPECT_EQ(second, gradient);
}

INSTANTIATE_TEST_SUITE_P(Available, ArithmeticTest,
                         ::testing::ValuesIn(AvailableArithmetics().begin(), AvailableArithmetics().end()),
                         Name);

TEST(Arithmetic, IsChosenByName) {
  const std::string first = CurrentArithmetic().name;
  EXPECT_EQ(first, AvailableArithmetics().front()->name);
  UseArithmetic("portable");
  EXPECT_STREQ(CurrentArithmetic().name, "portable");
  UseArithmetic(first);
  EXPECT_THROW(UseArithmetic("x86-64-v9"), Error);
  EXPECT_EQ(CurrentArithmetic().name, first);
}

}  // namespace
}  // namespace fresco
