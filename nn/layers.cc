#include "nn/layers.h"

#include <algorithm>
#include <cstring>

#include "nn/arithmetic.h"

namespace fresco {
namespace {

constexpr int kLine = 16;       // entries
constexpr int kSetStride = 64;  // entries

// The side of the squares in which a matrix is transposed.
constexpr int kBlock = 4;

/// Writes the transpose of a block [rows x columns], each at most kBlock.
void TransposeBlock(const float* from, int64_t from_stride, int rows, int columns, float* to,
                    int64_t to_stride) {
  if (rows < kBlock || columns < kBlock) {
    for (int column = 0; column < columns; ++column) {
      for (int row = 0; row < rows; ++row) {
        to[row * to_stride + column] = from[column * from_stride + row];
      }
    }
    return;
  }
  using Four [[gnu::vector_size(16)]] = float;
  Four in[kBlock];
  for (int column = 0; column < kBlock; ++column) {
    std::memcpy(&in[column], from + column * from_stride, sizeof(Four));
  }
  const Four low01 = __builtin_shufflevector(in[0], in[1], 0, 4, 1, 5);
  const Four high01 = __builtin_shufflevector(in[0], in[1], 2, 6, 3, 7);
  const Four low23 = __builtin_shufflevector(in[2], in[3], 0, 4, 1, 5);
  const Four high23 = __builtin_shufflevector(in[2], in[3], 2, 6, 3, 7);
  const Four out[kBlock] = {__builtin_shufflevector(low01, low23, 0, 1, 4, 5),
                            __builtin_shufflevector(low01, low23, 2, 3, 6, 7),
                            __builtin_shufflevector(high01, high23, 0, 1, 4, 5),
                            __builtin_shufflevector(high01, high23, 2, 3, 6, 7)};
  for (int row = 0; row < kBlock; ++row) {
    std::memcpy(to + row * to_stride, &out[row], sizeof(Four));
  }
}

}  // namespace

int PaddedRows(int units) {
  const int padded = (units + kLine - 1) / kLine * kLine;
  return padded % kSetStride == 0 ? padded + kLine : padded;
}

Product ForwardProduct(std::span<const float> parameters, const Layer& layer, const Matrix& below,
                       ColumnRange columns, Finish finish, Matrix& above) {
  Product product;
  product.rows = layer.outputs;
  product.columns = columns.end - columns.first;
  product.inner = layer.inputs;
  product.a = parameters.data() + layer.weights;
  product.a_stride = product.rows;
  product.b = below.col(columns.first).data();
  product.b_stride = below.rows();
  product.bias = parameters.data() + layer.biases();
  product.result = above.col(columns.first).data();
  product.result_stride = above.rows();
  product.finish = finish;
  return product;
}

void TransposePart(std::span<const float> parameters, const Layer& layer, const ParameterPart& part,
                   Matrix& transposed) {
  const float* weights = parameters.data() + layer.weights;
  for (int output = 0; output < layer.outputs; output += kBlock) {
    for (int input = part.first_input; input < part.end_input; input += kBlock) {
      TransposeBlock(weights + int64_t{input} * layer.outputs + output, layer.outputs,
                     std::min(kBlock, layer.outputs - output), std::min(kBlock, part.end_input - input),
                     transposed.col(output).data() + input, transposed.rows());
    }
  }
}

Product BackwardProduct(const Layer& layer, const Matrix& transposed, const Matrix& above,
                        ColumnRange columns, const Matrix& activations, Matrix& below) {
  Product product;
  product.rows = layer.inputs;
  product.columns = columns.end - columns.first;
  product.inner = layer.outputs;
  product.a = transposed.data();
  product.a_stride = transposed.rows();
  product.b = above.col(columns.first).data();
  product.b_stride = above.rows();
  product.result = below.col(columns.first).data();
  product.result_stride = below.rows();
  product.finish = Finish::kGate;
  product.gate = activations.col(columns.first).data();
  product.gate_stride = activations.rows();
  return product;
}

void PartGradient(const Layer& layer, const ParameterPart& part, const Matrix& above, const Matrix& below,
                  int columns, std::span<float> gradient) {
  const Arithmetic& arithmetic = CurrentArithmetic();
  Product product;
  product.rows = layer.outputs;
  product.columns = part.end_input - part.first_input;
  product.inner = columns;
  product.a = above.data();
  product.a_stride = above.rows();
  product.b = below.data() + part.first_input;
  product.b_row_stride = below.rows();
  product.b_stride = 1;
  product.result = gradient.data();
  product.result_stride = layer.outputs;
  arithmetic.multiply(product);
  if (part.end_input == layer.inputs) {
    float* biases = gradient.data() + (layer.biases() - part.first);
    std::fill_n(biases, layer.outputs, 0.0f);
    for (int column = 0; column < columns; ++column) {
      arithmetic.add_scaled(layer.outputs, 1.0f, above.col(column).data(), biases);
    }
  }
}

}  // namespace fresco
