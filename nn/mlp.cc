#include "nn/mlp.h"

#include <algorithm>
#include <cmath>

#include "core/bytes.h"
#include "core/error.h"
#include "core/random.h"

namespace fresco {
namespace {

// Eigen divides a product into blocks by the processor's cache sizes, and the blocks decide the order of
// additions. Fixed sizes give the same bits on every host.
[[maybe_unused]] const bool kCacheSizesAreFixed = [] {
  Eigen::setCpuCacheSizes(32 * 1024, 512 * 1024, 4 * 1024 * 1024);
  return true;
}();

// A column of a product has the same bits for every width that is a multiple of this.
constexpr int kColumnMultiple = 8;

int Padded(int batch) {
  return (batch + kColumnMultiple - 1) / kColumnMultiple * kColumnMultiple;
}

using ConstMatrixMap = Eigen::Map<const Matrix>;
using ConstVectorMap = Eigen::Map<const Vector>;

ConstMatrixMap Weights(const MlpShape& shape, int layer, const float* parameters) {
  return {parameters + shape.weights_offset(layer), shape.layer_outputs(layer), shape.layer_inputs(layer)};
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
  mlp.Forward(Values(parameters), kBatch, workspace);
  const Matrix& output = workspace.output();
  return Crc32c(std::span<const float>(output.data(), static_cast<size_t>(output.size())));
}

}  // namespace

std::span<const float> Values(const Vector& vector) {
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

MlpWorkspace::MlpWorkspace(const MlpShape& shape, int batch_capacity) {
  FRESCO_CHECK(batch_capacity >= 1);
  for (const int size : shape.layer_sizes()) {
    activations_.push_back(Matrix::Zero(size, Padded(batch_capacity)));
  }
}

int64_t MlpWorkspace::BytesFor(const MlpShape& shape, int batch_capacity, bool backward) {
  int64_t units = 0;
  for (const int size : shape.layer_sizes()) {
    units += size;
  }
  return units * Padded(batch_capacity) * static_cast<int64_t>(sizeof(Matrix::Scalar)) * (backward ? 2 : 1);
}

void Mlp::Forward(std::span<const float> parameters, int batch, MlpWorkspace& workspace) const {
  FRESCO_CHECK(static_cast<int64_t>(parameters.size()) == shape_.parameter_count());
  FRESCO_CHECK(batch >= 1 && batch <= workspace.input().cols());
  const int columns = Padded(batch);
  for (int layer = 0; layer < shape_.layers(); ++layer) {
    const auto below = workspace.activations_[static_cast<size_t>(layer)].leftCols(columns);
    auto above = workspace.activations_[static_cast<size_t>(layer) + 1].leftCols(columns);
    above.noalias() = Weights(shape_, layer, parameters.data()) * below;
    const ConstVectorMap biases(parameters.data() + shape_.biases_offset(layer), shape_.layer_outputs(layer));
    if (layer + 1 < shape_.layers()) {
      above = (above.colwise() + biases).cwiseMax(0.0f);
    } else {
      above.colwise() += biases;
    }
  }
}

void Mlp::Backward(std::span<const float> parameters, int batch, const Matrix& output_gradient,
                   MlpWorkspace& workspace, std::span<float> gradient) const {
  FRESCO_CHECK(static_cast<int64_t>(gradient.size()) == shape_.parameter_count());
  FRESCO_CHECK(output_gradient.rows() == shape_.outputs() && output_gradient.cols() >= batch);
  auto& gradients = workspace.gradients_;
  if (gradients.empty()) {
    for (const Matrix& activation : workspace.activations_) {
      gradients.push_back(Matrix::Zero(activation.rows(), activation.cols()));
    }
  }
  gradients.back().leftCols(batch) = output_gradient.leftCols(batch);
  for (int layer = shape_.layers() - 1; layer >= 0; --layer) {
    const auto above = gradients[static_cast<size_t>(layer) + 1].leftCols(batch);
    const auto below = workspace.activations_[static_cast<size_t>(layer)].leftCols(batch);
    Eigen::Map<Matrix> weights_gradient(gradient.data() + shape_.weights_offset(layer),
                                        shape_.layer_outputs(layer), shape_.layer_inputs(layer));
    Eigen::Map<Vector> biases_gradient(gradient.data() + shape_.biases_offset(layer),
                                       shape_.layer_outputs(layer));
    weights_gradient.noalias() = above * below.transpose();
    biases_gradient = above.col(0);
    for (int column = 1; column < batch; ++column) {
      biases_gradient += above.col(column);  // one by one: the order of additions is fixed
    }
    if (layer > 0) {
      auto next = gradients[static_cast<size_t>(layer)].leftCols(batch);
      next.noalias() = Weights(shape_, layer, parameters.data()).transpose() * above;
      next = (below.array() > 0.0f).select(next, 0.0f);
    }
  }
}

uint32_t ArithmeticFingerprint() {
  static const uint32_t fingerprint = ComputeFingerprint();  // takes milliseconds
  return fingerprint;
}

}  // namespace fresco
