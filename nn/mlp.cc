#include "nn/mlp.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/bytes.h"
#include "core/error.h"
#include "core/random.h"
#include "nn/arithmetic.h"

namespace fresco {
namespace {

// A workspace's columns begin at lines of the cache, but not all at lines of the same set of it.
constexpr int kLine = 16;       // entries
constexpr int kSetStride = 64;  // entries

int PaddedRows(int units) {
  const int padded = (units + kLine - 1) / kLine * kLine;
  return padded % kSetStride == 0 ? padded + kLine : padded;
}

// What a thread computes at a time: columns of a batch, and about so many parameters.
constexpr int kColumnsAtOnce = 200;
constexpr int kParametersOfPart = 4096;
constexpr int kInputMultiple = 8;

std::vector<ParameterPart> PartsOf(const MlpShape& shape) {
  std::vector<ParameterPart> parts;
  for (int layer = 0; layer < shape.layers(); ++layer) {
    const int inputs = shape.layer_inputs(layer);
    const int outputs = shape.layer_outputs(layer);
    const int multiples = std::max(1, kParametersOfPart / (outputs * kInputMultiple));
    for (int input = 0; input < inputs; input += multiples * kInputMultiple) {
      const int end = std::min(inputs, input + multiples * kInputMultiple);
      const int64_t first = shape.weights_offset(layer) + int64_t{input} * outputs;
      const int64_t biases = end == inputs ? 1 : 0;
      parts.push_back({layer, input, end, first, first + (end - input + biases) * int64_t{outputs}});
    }
  }
  return parts;
}

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

uint32_t ComputeFingerprint() {
  constexpr int kBatch = 24;
  const Mlp mlp(MlpShape({7, 200, 256, 20}));
  const Vector parameters = InitialParameters(mlp.shape(), 1);
  MlpWorkspace workspace(mlp.shape(), kBatch);
  RandomStream stream(1, RandomPurpose::kInitialWeights, ~0u, 0);
  for (int column = 0; column < kBatch; ++column) {
    for (int row = 0; row < mlp.shape().inputs(); ++row) {
      workspace.input()(row, column) = static_cast<float>(stream.NextUniform());
    }
  }
  mlp.Forward(Values(parameters), {0, kBatch}, workspace);
  const Matrix& output = workspace.output();
  return Crc32c(std::span<const float>(output.data(), static_cast<size_t>(output.size())));
}

}  // namespace

std::span<const float> Values(const Vector& vector) {
  return {vector.data(), static_cast<size_t>(vector.size())};
}

std::span<float> Values(Vector& vector) {
  return {vector.data(), static_cast<size_t>(vector.size())};
}

MlpShape::MlpShape(std::vector<int> layer_sizes) : layer_sizes_(std::move(layer_sizes)) {
  FRESCO_CHECK(layer_sizes_.size() >= 2);
  FRESCO_CHECK(std::all_of(layer_sizes_.begin(), layer_sizes_.end(), [](int size) { return size >= 1; }));
  offsets_.push_back(0);
  for (size_t layer = 0; layer + 1 < layer_sizes_.size(); ++layer) {
    offsets_.push_back(offsets_.back() + (int64_t{layer_sizes_[layer]} + 1) * layer_sizes_[layer + 1]);
  }
}

Vector InitialParameters(const MlpShape& shape, uint64_t seed) {
  Vector parameters = Vector::Zero(shape.parameter_count());
  for (int layer = 0; layer < shape.layers(); ++layer) {
    RandomStream stream(seed, RandomPurpose::kInitialWeights, static_cast<uint32_t>(layer), 0);
    const double bound = std::sqrt(6.0 / shape.layer_inputs(layer));
    for (int64_t i = shape.weights_offset(layer); i < shape.biases_offset(layer); ++i) {
      parameters(i) = static_cast<float>((2 * stream.NextUniform() - 1) * bound);
    }
  }
  return parameters;
}

MlpWorkspace::MlpWorkspace(const MlpShape& shape, int batch_capacity, Passes passes) {
  FRESCO_CHECK(batch_capacity >= 1);
  const int layers = shape.layers();
  for (int layer = 0; layer <= layers; ++layer) {
    const int units = shape.layer_sizes()[static_cast<size_t>(layer)];
    const bool hidden = layer > 0 && layer < layers;
    activations_.push_back(Matrix::Zero(hidden ? PaddedRows(units) : units, batch_capacity));
  }
  if (passes == Passes::kForward) {
    return;
  }
  gradients_.resize(static_cast<size_t>(layers));
  transposed_.resize(static_cast<size_t>(layers));
  for (int layer = 1; layer < layers; ++layer) {
    const int64_t rows = PaddedRows(shape.layer_inputs(layer));
    gradients_[static_cast<size_t>(layer)] = Matrix::Zero(rows, batch_capacity);
    transposed_[static_cast<size_t>(layer)] = Matrix::Zero(rows, shape.layer_outputs(layer));
  }
  transposed_gradient_ = Matrix::Zero(shape.layer_inputs(layers - 1), shape.outputs());
}

int64_t MlpWorkspace::BytesFor(const MlpShape& shape, int batch_capacity, Passes passes) {
  const int layers = shape.layers();
  int64_t entries = int64_t{shape.inputs() + shape.outputs()} * batch_capacity;
  for (int layer = 1; layer < layers; ++layer) {
    const int64_t rows = PaddedRows(shape.layer_inputs(layer));
    entries += rows * batch_capacity;
    if (passes == Passes::kForwardAndBackward) {
      entries += rows * (batch_capacity + shape.layer_outputs(layer));
    }
  }
  if (passes == Passes::kForwardAndBackward) {
    entries += int64_t{shape.layer_inputs(layers - 1)} * shape.outputs();
  }
  return entries * static_cast<int64_t>(sizeof(Matrix::Scalar));
}

Mlp::Mlp(MlpShape shape) : shape_(std::move(shape)), parts_(PartsOf(shape_)) {}

void Mlp::Forward(std::span<const float> parameters, ColumnRange columns, MlpWorkspace& workspace) const {
  FRESCO_CHECK(static_cast<int64_t>(parameters.size()) == shape_.parameter_count());
  FRESCO_CHECK(columns.first >= 0 && columns.end <= workspace.input().cols());
  const Arithmetic& arithmetic = CurrentArithmetic();
  for (int column = columns.first; column < columns.end; column += kColumnsAtOnce) {
    for (int layer = 0; layer < shape_.layers(); ++layer) {
      const Matrix& below = workspace.activations_[static_cast<size_t>(layer)];
      Matrix& above = workspace.activations_[static_cast<size_t>(layer) + 1];
      Product product;
      product.rows = shape_.layer_outputs(layer);
      product.columns = std::min(kColumnsAtOnce, columns.end - column);
      product.inner = shape_.layer_inputs(layer);
      product.a = parameters.data() + shape_.weights_offset(layer);
      product.a_stride = product.rows;
      product.b = below.col(column).data();
      product.b_stride = below.rows();
      product.bias = parameters.data() + shape_.biases_offset(layer);
      product.result = above.col(column).data();
      product.result_stride = above.rows();
      product.finish = layer + 1 < shape_.layers() ? Finish::kRelu : Finish::kNothing;
      arithmetic.multiply(product);
    }
  }
}

void Mlp::Transpose(std::span<const float> parameters, const ParameterPart& part,
                    MlpWorkspace& workspace) const {
  if (part.layer == 0) {
    return;  // nobody needs the gradient of the network's input
  }
  const int outputs = shape_.layer_outputs(part.layer);
  const float* weights = parameters.data() + shape_.weights_offset(part.layer);
  Matrix& transposed = workspace.transposed_[static_cast<size_t>(part.layer)];
  for (int output = 0; output < outputs; output += kBlock) {
    for (int input = part.first_input; input < part.end_input; input += kBlock) {
      TransposeBlock(weights + int64_t{input} * outputs + output, outputs, std::min(kBlock, outputs - output),
                     std::min(kBlock, part.end_input - input), transposed.col(output).data() + input,
                     transposed.rows());
    }
  }
}

void Mlp::BackwardColumns(const OutputGradient& output_gradient, ColumnRange columns,
                          MlpWorkspace& workspace) const {
  const int last = shape_.layers() - 1;
  if (last == 0) {
    return;
  }
  const int units = shape_.layer_inputs(last);
  const Matrix& transposed = workspace.transposed_[static_cast<size_t>(last)];
  const Arithmetic& arithmetic = CurrentArithmetic();
  for (int column = columns.first; column < columns.end; ++column) {
    const auto i = static_cast<size_t>(column);
    Product product;
    product.rows = units;
    product.columns = 1;
    product.inner = 1;
    product.a = transposed.col(output_gradient.units[i]).data();
    product.b = &output_gradient.values[i];
    product.result = workspace.gradients_[static_cast<size_t>(last)].col(column).data();
    product.finish = Finish::kGate;
    product.gate = workspace.activations_[static_cast<size_t>(last)].col(column).data();
    arithmetic.multiply(product);
  }
  for (int column = columns.first; column < columns.end; column += kColumnsAtOnce) {
    for (int layer = last - 1; layer > 0; --layer) {
      const Matrix& weights = workspace.transposed_[static_cast<size_t>(layer)];
      const Matrix& above = workspace.gradients_[static_cast<size_t>(layer) + 1];
      const Matrix& activations = workspace.activations_[static_cast<size_t>(layer)];
      Matrix& below = workspace.gradients_[static_cast<size_t>(layer)];
      Product product;
      product.rows = shape_.layer_inputs(layer);
      product.columns = std::min(kColumnsAtOnce, columns.end - column);
      product.inner = shape_.layer_outputs(layer);
      product.a = weights.data();
      product.a_stride = weights.rows();
      product.b = above.col(column).data();
      product.b_stride = above.rows();
      product.result = below.col(column).data();
      product.result_stride = below.rows();
      product.finish = Finish::kGate;
      product.gate = activations.col(column).data();
      product.gate_stride = activations.rows();
      arithmetic.multiply(product);
    }
  }
}

int64_t Mlp::LargestPart(const MlpShape& shape) {
  int64_t largest = 0;
  for (const ParameterPart& part : PartsOf(shape)) {
    largest = std::max(largest, part.size());
  }
  return largest;
}

void Mlp::BackwardPart(const OutputGradient& output_gradient, int batch, const ParameterPart& part,
                       MlpWorkspace& workspace, std::span<float> gradient) const {
  FRESCO_CHECK(static_cast<int64_t>(gradient.size()) == part.size());
  if (part.layer == shape_.layers() - 1) {
    LastLayerGradient(output_gradient, batch, part, workspace, gradient);
    return;
  }
  const Arithmetic& arithmetic = CurrentArithmetic();
  const Matrix& above = workspace.gradients_[static_cast<size_t>(part.layer) + 1];
  const Matrix& below = workspace.activations_[static_cast<size_t>(part.layer)];
  const int outputs = shape_.layer_outputs(part.layer);
  Product product;
  product.rows = outputs;
  product.columns = part.end_input - part.first_input;
  product.inner = batch;
  product.a = above.data();
  product.a_stride = above.rows();
  product.b = below.data() + part.first_input;
  product.b_row_stride = below.rows();
  product.b_stride = 1;
  product.result = gradient.data();
  product.result_stride = outputs;
  arithmetic.multiply(product);
  if (part.end_input == shape_.layer_inputs(part.layer)) {
    float* biases = gradient.data() + (shape_.biases_offset(part.layer) - part.first);
    std::fill_n(biases, outputs, 0.0f);
    for (int column = 0; column < batch; ++column) {
      arithmetic.add_scaled(outputs, 1.0f, above.col(column).data(), biases);
    }
  }
}

/// The gradient of the last layer. Only one output of each column has any, so the sums have few terms.
void Mlp::LastLayerGradient(const OutputGradient& output_gradient, int batch, const ParameterPart& part,
                            MlpWorkspace& workspace, std::span<float> gradient) const {
  const Arithmetic& arithmetic = CurrentArithmetic();
  const Matrix& below = workspace.activations_[static_cast<size_t>(part.layer)];
  const int outputs = shape_.outputs();
  const int inputs = part.end_input - part.first_input;
  auto transposed = workspace.transposed_gradient_.middleRows(part.first_input, inputs);
  transposed.setZero();
  for (int column = 0; column < batch; ++column) {
    arithmetic.add_scaled(inputs, output_gradient.values[static_cast<size_t>(column)],
                          below.col(column).data() + part.first_input,
                          transposed.col(output_gradient.units[static_cast<size_t>(column)]).data());
  }
  Eigen::Map<Matrix>(gradient.data(), outputs, inputs) = transposed.transpose();
  if (part.end_input == shape_.layer_inputs(part.layer)) {
    float* biases = gradient.data() + (shape_.biases_offset(part.layer) - part.first);
    std::fill_n(biases, outputs, 0.0f);
    for (int column = 0; column < batch; ++column) {
      const auto i = static_cast<size_t>(column);
      biases[output_gradient.units[i]] += output_gradient.values[i];
    }
  }
}

uint32_t ArithmeticFingerprint() {
  static const uint32_t fingerprint = ComputeFingerprint();  // takes milliseconds
  return fingerprint;
}

}  // namespace fresco
