// The multilayer perceptron: one chain of fully connected layers with ReLU between them and a linear output.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "nn/network.h"

namespace fresco {

/// The layer sizes of a network, and the position of each layer's parameters in the flat vector.
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

class MlpWorkspace : public NetworkWorkspace {
 public:
  /// `batch_capacity` (>= 1): the largest batch. `passes`: which ones it is for.
  MlpWorkspace(const MlpShape& shape, int batch_capacity, Passes passes = Passes::kForward);

  Matrix& input() override { return activations_.front(); }
  const Matrix& output() const override { return activations_.back(); }

 private:
  friend class Mlp;
  // The columns of hidden layers are longer than the layer, so that they begin at the cache's lines.
  std::vector<Matrix> activations_;  // [0] is the input, [l + 1] is the output of layer l
  // For the backward pass; the first and the last layers' entries that no pass needs are empty.
  std::vector<Matrix> gradients_;   // [l]: d loss / d activations_[l] before ReLU
  std::vector<Matrix> transposed_;  // [l]: the weights of layer l, [inputs x outputs]
  Matrix transposed_gradient_;      // of the last layer's weights
};

/// Network (nn/network.h) describes the functions.
class Mlp : public Network {
 public:
  explicit Mlp(MlpShape shape);
  const MlpShape& shape() const { return shape_; }

  int inputs() const override { return shape_.inputs(); }
  int outputs() const override { return shape_.outputs(); }
  std::vector<int> layer_sizes() const override { return shape_.layer_sizes(); }
  int64_t units() const override;
  std::unique_ptr<NetworkWorkspace> NewWorkspace(int batch_capacity,
                                                 NetworkWorkspace::Passes passes) const override;
  int64_t WorkspaceBytes(int batch_capacity, NetworkWorkspace::Passes passes) const override;
  void Forward(std::span<const float> parameters, ColumnRange columns,
               NetworkWorkspace& workspace) const override;
  /// Computes all outputs.
  void ForwardUnits(std::span<const float> parameters, std::span<const int16_t> units, ColumnRange columns,
                    NetworkWorkspace& workspace) const override;
  void Transpose(std::span<const float> parameters, const ParameterPart& part,
                 NetworkWorkspace& workspace) const override;
  void BackwardColumns(const OutputGradient& output_gradient, ColumnRange columns,
                       NetworkWorkspace& workspace) const override;
  void BackwardPart(const OutputGradient& output_gradient, int batch, const ParameterPart& part,
                    NetworkWorkspace& workspace, std::span<float> gradient) const override;

 private:
  void LastLayerGradient(const OutputGradient& output_gradient, int batch, const ParameterPart& part,
                         MlpWorkspace& workspace, std::span<float> gradient) const;

  MlpShape shape_;
};

/// Returns the CRC-32C of the outputs of a fixed network on fixed observations. Two programs with the same
/// value do arithmetic alike. An actor with another value than the learner's does not fly, since its results
/// would have other bits. Computed at the first call; any thread may call it.
uint32_t ArithmeticFingerprint();

}  // namespace fresco
