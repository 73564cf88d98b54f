// The multilayer perceptron: fully connected layers, ReLU between them, linear output. Parameters
// are one flat vector, so that the optimiser, the target copy, the wire and the checkpoint all see
// the same array. Single precision. Pure: no I/O, no clock, no hidden randomness; every reduction
// has a fixed order, so the same binary gives the same bits on the same instruction set.
//
// A batch is a matrix with one observation a column. The output of an observation has the same bits
// whatever the width of its batch, its column and the other columns are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fresco {

using Matrix = Eigen::MatrixXf;  ///< column-major, [units x batch]
using Vector = Eigen::VectorXf;

/// The sizes of a network and where each layer's parameters stand in the flat vector: for every
/// layer its weights [outputs x inputs], column-major, then its biases [outputs].
class MlpShape {
 public:
  /// layer_sizes: inputs, hidden layers' units, outputs; at least two entries, each >= 1.
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
  std::vector<int64_t> offsets_;  // where each layer begins; one more entry for the end
};

/// He-uniform weights, U(-sqrt(6 / inputs), sqrt(6 / inputs)), and zero biases, drawn from the
/// counter-based stream of `seed`: version 0 of both networks.
Vector InitialParameters(const MlpShape& shape, uint64_t seed);

/// The activations of one forward pass, reused from pass to pass: no allocation once warm.
/// Not thread-safe; one workspace per thread.
class MlpWorkspace {
 public:
  MlpWorkspace(const MlpShape& shape, int batch_capacity);

  /// What a workspace takes of memory: for Forward alone, or for Backward, too.
  static int64_t BytesFor(const MlpShape& shape, int batch_capacity, bool backward);

  /// Where the caller writes the observations before Forward: [inputs x batch_capacity].
  Matrix& input() { return activations_.front(); }

  /// The outputs of the last Forward: [outputs x batch_capacity]; columns from the batch size on are
  /// meaningless.
  const Matrix& output() const { return activations_.back(); }

 private:
  friend class Mlp;
  std::vector<Matrix> activations_;  // [0] the input, [l + 1] the output of layer l
  std::vector<Matrix> gradients_;  // d loss / d (output of layer l before ReLU); sized by the first Backward
};

/// The network's arithmetic; holds no parameters of its own.
class Mlp {
 public:
  explicit Mlp(MlpShape shape) : shape_(std::move(shape)) {}
  const MlpShape& shape() const { return shape_; }

  /// output = network(input) for the first `batch` columns of the workspace. `parameters` has
  /// parameter_count() entries; 1 <= batch <= the workspace's capacity.
  void Forward(std::span<const float> parameters, int batch, MlpWorkspace& workspace) const;

  /// Gradient of a loss with respect to the parameters, given d loss / d output [outputs x batch]
  /// of the last Forward on this workspace with the same parameters and batch. Overwrites
  /// `gradient` (parameter_count() entries).
  void Backward(std::span<const float> parameters, int batch, const Matrix& output_gradient,
                MlpWorkspace& workspace, std::span<float> gradient) const;

 private:
  MlpShape shape_;
};

/// CRC-32C over the outputs of a fixed network on fixed observations: two programs with the same
/// value do arithmetic alike, so the learner can refuse an actor whose binary or instruction set
/// would break bit-identity.
uint32_t ArithmeticFingerprint();

}  // namespace fresco
