#include "nn/mlp.h"

#include <algorithm>
#include <numeric>

#include "core/bytes.h"
#include "core/error.h"
#include "core/random.h"
#include "nn/arithmetic.h"
#include "nn/layers.h"

namespace fresco {
namespace {

std::vector<Layer> MlpLayers(const MlpShape& shape) {
  std::vector<Layer> layers;
  for (int layer = 0; layer < shape.layers(); ++layer) {
    layers.push_back({shape.layer_inputs(layer), shape.layer_outputs(layer), shape.weights_offset(layer)});
  }
  return layers;
}

/// The workspace that NewWorkspace made.
MlpWorkspace& Own(NetworkWorkspace& workspace) {
  return static_cast<MlpWorkspace&>(workspace);
}

uint32_t ComputeFingerprint() {
  constexpr int kBatch = 24;
  const Mlp mlp(MlpShape({7, 200, 256, 20}));
  const Vector parameters = mlp.InitialParameters(1);
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

MlpShape::MlpShape(std::vector<int> layer_sizes) : layer_sizes_(std::move(layer_sizes)) {
  FRESCO_CHECK(layer_sizes_.size() >= 2);
  FRESCO_CHECK(std::all_of(layer_sizes_.begin(), layer_sizes_.end(), [](int size) { return size >= 1; }));
  offsets_.push_back(0);
  for (size_t layer = 0; layer + 1 < layer_sizes_.size(); ++layer) {
    offsets_.push_back(offsets_.back() + (int64_t{layer_sizes_[layer]} + 1) * layer_sizes_[layer + 1]);
  }
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

Mlp::Mlp(MlpShape shape) : Network(MlpLayers(shape)), shape_(std::move(shape)) {}

int64_t Mlp::units() const {
  return std::accumulate(shape_.layer_sizes().begin(), shape_.layer_sizes().end(), int64_t{0});
}

std::unique_ptr<NetworkWorkspace> Mlp::NewWorkspace(int batch_capacity,
                                                    NetworkWorkspace::Passes passes) const {
  return std::make_unique<MlpWorkspace>(shape_, batch_capacity, passes);
}

int64_t Mlp::WorkspaceBytes(int batch_capacity, NetworkWorkspace::Passes passes) const {
  const bool backward = passes == NetworkWorkspace::Passes::kForwardAndBackward;
  const int layers = shape_.layers();
  int64_t entries = int64_t{shape_.inputs() + shape_.outputs()} * batch_capacity;
  for (int layer = 1; layer < layers; ++layer) {
    const int64_t rows = PaddedRows(shape_.layer_inputs(layer));
    entries += rows * batch_capacity;
    if (backward) {
      entries += rows * (batch_capacity + shape_.layer_outputs(layer));
    }
  }
  if (backward) {
    entries += int64_t{shape_.layer_inputs(layers - 1)} * shape_.outputs();
  }
  return entries * static_cast<int64_t>(sizeof(Matrix::Scalar));
}

void Mlp::Forward(std::span<const float> parameters, ColumnRange columns, NetworkWorkspace& workspace) const {
  std::vector<Matrix>& activations = Own(workspace).activations_;
  FRESCO_CHECK(static_cast<int64_t>(parameters.size()) == parameter_count());
  FRESCO_CHECK(columns.first >= 0 && columns.end <= activations.front().cols());
  const Arithmetic& arithmetic = CurrentArithmetic();
  for (int column = columns.first; column < columns.end; column += kColumnsAtOnce) {
    const ColumnRange block{column, std::min(column + kColumnsAtOnce, columns.end)};
    for (int i = 0; i < shape_.layers(); ++i) {
      const Finish finish = i + 1 < shape_.layers() ? Finish::kRelu : Finish::kNothing;
      const auto at = static_cast<size_t>(i);
      arithmetic.multiply(
          ForwardProduct(parameters, layer(i), activations[at], block, finish, activations[at + 1]));
    }
  }
}

void Mlp::ForwardUnits(std::span<const float> parameters, std::span<const int16_t>, ColumnRange columns,
                       NetworkWorkspace& workspace) const {
  Forward(parameters, columns, workspace);
}

void Mlp::Transpose(std::span<const float> parameters, const ParameterPart& part,
                    NetworkWorkspace& workspace) const {
  if (part.layer > 0) {  // nobody needs the gradient of the network's input
    TransposePart(parameters, layer(part.layer), part,
                  Own(workspace).transposed_[static_cast<size_t>(part.layer)]);
  }
}

void Mlp::BackwardColumns(const OutputGradient& output_gradient, ColumnRange columns,
                          NetworkWorkspace& network_workspace) const {
  const int last = shape_.layers() - 1;
  if (last == 0) {
    return;
  }
  MlpWorkspace& workspace = Own(network_workspace);
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
    const ColumnRange block{column, std::min(column + kColumnsAtOnce, columns.end)};
    for (int i = last - 1; i > 0; --i) {
      const auto at = static_cast<size_t>(i);
      arithmetic.multiply(BackwardProduct(layer(i), workspace.transposed_[at], workspace.gradients_[at + 1],
                                          block, workspace.activations_[at], workspace.gradients_[at]));
    }
  }
}

void Mlp::BackwardPart(const OutputGradient& output_gradient, int batch, const ParameterPart& part,
                       NetworkWorkspace& network_workspace, std::span<float> gradient) const {
  FRESCO_CHECK(static_cast<int64_t>(gradient.size()) == part.size());
  MlpWorkspace& workspace = Own(network_workspace);
  if (part.layer == shape_.layers() - 1) {
    LastLayerGradient(output_gradient, batch, part, workspace, gradient);
    return;
  }
  const auto at = static_cast<size_t>(part.layer);
  PartGradient(layer(part.layer), part, workspace.gradients_[at + 1], workspace.activations_[at], batch,
               gradient);
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
