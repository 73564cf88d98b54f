// The multilayer perceptron: fully connected layers with ReLU between them and a linear output, in single
// precision. All parameters are one flat vector, which the optimiser, the target network, the messages and
// the checkpoints share as their format. No I/O, no clock, no hidden randomness. Every number is defined to
// the bit (nn/arithmetic_kernels.h), so every processor gives the same ones. MlpShape and Mlp are immutable,
// so any number of threads may share them.
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
std::span<float> Values(Vector& vector);

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

/// Columns of a batch, from `first` to before `end`.
struct ColumnRange {
  int first = 0;
  int end = 0;
};

/// A contiguous part of the parameters: the weights from some inputs of one layer, with the layer's biases if
/// these are its last inputs.
struct ParameterPart {
  int layer = 0;
  int first_input = 0;
  int end_input = 0;
  int64_t first = 0;  ///< in the flat vector
  int64_t end = 0;
  int64_t size() const { return end - first; }
};

/// d loss / d output of a batch whose loss depends on one output in each column.
struct OutputGradient {
  std::span<const int16_t> units;  ///< which output, by column
  std::span<const float> values;   ///< d loss / d this output, by column
};

/// Holds the activations of a forward pass and the gradients of a backward pass, so that passes do not
/// allocate. Threads may share one if each has columns and parts of its own.
class MlpWorkspace {
 public:
  enum class Passes { kForward, kForwardAndBackward };

  /// `batch_capacity` (>= 1): the largest batch. `passes`: which ones it is for.
  MlpWorkspace(const MlpShape& shape, int batch_capacity, Passes passes = Passes::kForward);

  /// The memory of a workspace, bytes.
  static int64_t BytesFor(const MlpShape& shape, int batch_capacity, Passes passes);

  /// The observations, which the caller writes before Forward: [inputs x batch_capacity].
  Matrix& input() { return activations_.front(); }

  /// The outputs of Forward: [outputs x batch_capacity]. Only the columns that it computed have a meaning.
  const Matrix& output() const { return activations_.back(); }

 private:
  friend class Mlp;
  // The columns of hidden layers are longer than the layer, so that they begin at the cache's lines.
  std::vector<Matrix> activations_;  // [0] is the input, [l + 1] is the output of layer l
  // For the backward pass; the first and the last layers' entries that no pass needs are empty.
  std::vector<Matrix> gradients_;   // [l]: d loss / d activations_[l] before ReLU
  std::vector<Matrix> transposed_;  // [l]: the weights of layer l, [inputs x outputs]
  Matrix transposed_gradient_;      // of the last layer's weights
};

/// Computes outputs and gradients of a network of one shape. It holds no parameters.
///
/// A backward pass has two stages. In the first one every column can be computed by itself, in the second one
/// every part of the parameters. So threads can share both; neither their number nor the ranges that a caller
/// chooses change a bit.
class Mlp {
 public:
  explicit Mlp(MlpShape shape);
  const MlpShape& shape() const { return shape_; }

  /// Computes the outputs of some columns of the workspace's input. CHECKs that `parameters` has
  /// parameter_count() entries and that the workspace has the columns.
  void Forward(std::span<const float> parameters, ColumnRange columns, MlpWorkspace& workspace) const;

  /// The parts of the parameters, which together are all of them, in ascending order.
  const std::vector<ParameterPart>& parts() const { return parts_; }
  /// The most parameters of a part.
  static int64_t LargestPart(const MlpShape& shape);

  /// Prepares the backward pass: call it for every part whose parameters have changed.
  void Transpose(std::span<const float> parameters, const ParameterPart& part, MlpWorkspace& workspace) const;

  /// The first stage, after Forward and Transpose: computes d loss / d hidden units for some columns.
  void BackwardColumns(const OutputGradient& output_gradient, ColumnRange columns,
                       MlpWorkspace& workspace) const;

  /// The second stage, after the first one of all columns of a batch: computes d loss / d parameters of a
  /// part, `gradient` (part.size() entries).
  void BackwardPart(const OutputGradient& output_gradient, int batch, const ParameterPart& part,
                    MlpWorkspace& workspace, std::span<float> gradient) const;

 private:
  void LastLayerGradient(const OutputGradient& output_gradient, int batch, const ParameterPart& part,
                         MlpWorkspace& workspace, std::span<float> gradient) const;

  MlpShape shape_;
  std::vector<ParameterPart> parts_;
};

/// Returns the CRC-32C of the outputs of a fixed network on fixed observations. Two programs with the same
/// value do arithmetic alike. An actor with another value than the learner's does not fly, since its results
/// would have other bits. Computed at the first call; any thread may call it.
uint32_t ArithmeticFingerprint();

}  // namespace fresco
