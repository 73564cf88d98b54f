// The multilayer perceptron: fully connected layers with ReLU between them and a linear output, in single
// precision. All parameters are one flat vector, which the optimiser, the target network, the messages and
// the checkpoints share as their format. No I/O, no clock, no hidden randomness. Every sum has a fixed order,
// so the same binary gives the same bits on the same instruction set. MlpShape and Mlp are immutable, so any
// number of threads may share them.
//
// A batch is a matrix in which each column is one observation. The output of an observation has the same bits
// in every batch, whatever the batch's width, the observation's column and the other columns.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fresco {

using Matrix = Eigen::MatrixXf;  ///< column-major, [units x batch]
using Vector = Eigen::VectorXf;

/// The values of a vector, as long as it lives and keeps its size.
std::span<const float> Values(const Vector& vector);

/// The layer sizes of a network, and the position of each layer's parameters in the flat vector. A layer has
/// its weights [outputs x inputs], column by column, then its biases [outputs].
class MlpShape {
 public:
  /// `layer_sizes`: number of inputs, units of each hidden layer, number of outputs. CHECKs that there are at
  /// least two entries, each >= 1.
  explicit MlpShape(std::vector<int> layer_sizes);

  int inputs() const { return layer_sizes_.front(); }
  int outputs() const { return layer_sizes_.back(); }
  int layers() const { return static_cast<int>(layer_sizes_.size()) - 1; }
  const std::vector<int>& layer_sizes() const { return layer_sizes_; }
  int64_t parameter_count() const { return offsets_.back(); }

  int layer_inputs(int layer) const { return layer_sizes_[static_cast<size_t>(layer)]; }
  int layer_outputs(int layer) const { return layer_sizes_[static_cast<size_t>(layer) + 1]; }
  int64_t weights_offset(int layer) const { return offsets_[static_cast<size_t>(layer)]; }
  int64_t biases_offset(int layer) const {
    return weights_offset(layer) + int64_t{layer_inputs(layer)} * layer_outputs(layer);
  }

 private:
  std::vector<int> layer_sizes_;
  std::vector<int64_t> offsets_;  // where each layer's parameters begin, and where the last one's end
};

/// Returns the initial parameters, which are version 0 of both networks: He-uniform weights, U(-sqrt(6 /
/// inputs), sqrt(6 / inputs)), and zero biases. They depend on the shape and the seed only (core/random.h).
Vector InitialParameters(const MlpShape& shape, uint64_t seed);

/// Holds the activations of a forward pass and the gradients of a backward pass, so that passes do not
/// allocate (the first backward pass does). Not thread-safe; each thread has a workspace of its own.
class MlpWorkspace {
 public:
  /// `batch_capacity` (>= 1): the largest batch.
  MlpWorkspace(const MlpShape& shape, int batch_capacity);

  /// The memory of a workspace, bytes. `backward` says whether Backward is used, too.
  static int64_t BytesFor(const MlpShape& shape, int batch_capacity, bool backward);

  /// The observations, which the caller writes before Forward: [inputs x at least batch_capacity].
  Matrix& input() { return activations_.front(); }

  /// The outputs of the last Forward: [outputs x at least batch_capacity]. Only the columns of the batch have
  /// a meaning.
  const Matrix& output() const { return activations_.back(); }

 private:
  friend class Mlp;
  std::vector<Matrix> activations_;  // [0] is the input, [l + 1] is the output of layer l
  std::vector<Matrix> gradients_;  // d loss / d (output of layer l before ReLU); sized by the first Backward
};

/// Computes outputs and gradients of a network of one shape. It holds no parameters.
class Mlp {
 public:
  explicit Mlp(MlpShape shape) : shape_(std::move(shape)) {}
  const MlpShape& shape() const { return shape_; }

  /// Computes the outputs of the first `batch` columns of the workspace's input. CHECKs that `parameters` has
  /// parameter_count() entries and that 1 <= batch <= the workspace's capacity.
  void Forward(std::span<const float> parameters, int batch, MlpWorkspace& workspace) const;

  /// Computes the gradient of a loss with respect to the parameters and writes it to `gradient`
  /// (parameter_count() entries). `output_gradient` [outputs x batch] is d loss / d output of the last
  /// Forward on this workspace, which had the same parameters and batch.
  void Backward(std::span<const float> parameters, int batch, const Matrix& output_gradient,
                MlpWorkspace& workspace, std::span<float> gradient) const;

 private:
  MlpShape shape_;
};

/// Returns the CRC-32C of the outputs of a fixed network on fixed observations. Two programs with the same
/// value do arithmetic alike. An actor with another value than the learner's does not fly, since its binary
/// or instruction set would give other bits. Computed at the first call; any thread may call it.
uint32_t ArithmeticFingerprint();

}  // namespace fresco
