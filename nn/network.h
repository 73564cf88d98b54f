// A network of fully connected layers with ReLU between them, in single precision: what Mlp (nn/mlp.h) and
// SetNetwork (nn/set_network.h) have in common. All parameters are one flat vector, which the optimiser, the
// target network, the messages and the checkpoints share as their format. No I/O, no clock, no hidden
// randomness. Every number is defined to the bit (nn/arithmetic_kernels.h), so every processor gives the same
// ones. A network holds no parameters and is immutable, so any number of threads may share it.
//
// A batch is a matrix in which each column is one observation. The output of an observation has the same bits
// in every batch, whatever the batch's width, the observation's column and the other columns.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fresco {

using Matrix = Eigen::MatrixXf;  ///< column-major, [units x batch]
using Vector = Eigen::VectorXf;

/// The values of a vector, as long as it lives and keeps its size.
std::span<const float> Values(const Vector& vector);
std::span<float> Values(Vector& vector);

/// A fully connected layer, and where its parameters are in the flat vector: its weights [outputs x inputs],
/// column by column, then its biases [outputs].
struct Layer {
  int inputs = 0;
  int outputs = 0;
  int64_t weights = 0;
  int64_t biases() const { return weights + int64_t{inputs} * outputs; }
  int64_t end() const { return biases() + outputs; }
};

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
/// allocate. Threads may share one if each has columns and parts of its own. Only the network that made it
/// may use it.
class NetworkWorkspace {
 public:
  enum class Passes { kForward, kForwardAndBackward };

  virtual ~NetworkWorkspace() = default;

  /// The observations, which the caller writes before a forward pass: [inputs x batch capacity].
  virtual Matrix& input() = 0;

  /// The outputs of a forward pass: [outputs x batch capacity]. Only those that it computed have a meaning.
  virtual const Matrix& output() const = 0;
};

/// Computes outputs and gradients.
///
/// A backward pass has two stages. In the first one every column can be computed by itself, in the second one
/// every part of the parameters. So threads can share both; neither their number nor the ranges that a caller
/// chooses change a bit.
class Network {
 public:
  virtual ~Network() = default;

  virtual int inputs() const = 0;
  virtual int outputs() const = 0;
  int64_t parameter_count() const { return layers_.back().end(); }

  /// Number of inputs, units of each hidden layer, number of outputs; one such list after the other, with a 0
  /// between them, if the network has several chains of layers. Parameters of one network fit another one
  /// exactly if both have the same list.
  virtual std::vector<int> layer_sizes() const = 0;

  /// The numbers that a forward pass computes for a column, its observation included.
  virtual int64_t units() const = 0;

  /// Returns the initial parameters, which are version 0 of both networks: He-uniform weights, U(-sqrt(6 /
  /// inputs), sqrt(6 / inputs)), and zero biases. They depend on the layers and the seed only
  /// (core/random.h).
  Vector InitialParameters(uint64_t seed) const;

  /// `batch_capacity` (>= 1): the largest batch. `passes`: which ones it is for.
  virtual std::unique_ptr<NetworkWorkspace> NewWorkspace(int batch_capacity,
                                                         NetworkWorkspace::Passes passes) const = 0;
  /// The memory of a workspace, bytes.
  virtual int64_t WorkspaceBytes(int batch_capacity, NetworkWorkspace::Passes passes) const = 0;

  /// Computes the outputs of some columns of the workspace's input. CHECKs that `parameters` has
  /// parameter_count() entries and that the workspace has the columns.
  virtual void Forward(std::span<const float> parameters, ColumnRange columns,
                       NetworkWorkspace& workspace) const = 0;

  /// The same for one output of each column, units[column], to the same bits. May compute others, too.
  virtual void ForwardUnits(std::span<const float> parameters, std::span<const int16_t> units,
                            ColumnRange columns, NetworkWorkspace& workspace) const = 0;

  /// The parts of the parameters, which together are all of them, in ascending order.
  const std::vector<ParameterPart>& parts() const { return parts_; }
  /// The most parameters of a part.
  int64_t LargestPart() const;

  /// Prepares the backward pass: call it for every part whose parameters have changed.
  virtual void Transpose(std::span<const float> parameters, const ParameterPart& part,
                         NetworkWorkspace& workspace) const = 0;

  /// The first stage, after Transpose and ForwardUnits for the same units: computes d loss / d hidden units
  /// for some columns.
  virtual void BackwardColumns(const OutputGradient& output_gradient, ColumnRange columns,
                               NetworkWorkspace& workspace) const = 0;

  /// The second stage, after the first one of all columns of a batch: computes d loss / d parameters of a
  /// part, `gradient` (part.size() entries).
  virtual void BackwardPart(const OutputGradient& output_gradient, int batch, const ParameterPart& part,
                            NetworkWorkspace& workspace, std::span<float> gradient) const = 0;

 protected:
  /// `layers`: at least one, each where the one before it ends.
  explicit Network(std::vector<Layer> layers);

  const std::vector<Layer>& layers() const { return layers_; }
  const Layer& layer(int i) const { return layers_[static_cast<size_t>(i)]; }

 private:
  std::vector<Layer> layers_;
  std::vector<ParameterPart> parts_;
};

}  // namespace fresco
