// A network for observations that hold a set of alike items, such as the sensors of a field: it has the same
// small networks for every item, so the number of items is free and their order does not matter.
//
// An observation is `own_inputs` numbers of the agent itself, then `item_inputs` numbers of each of `items`
// items, item after item. The first number of an item is 0 if the item is absent; then nothing depends on its
// other numbers. There are groups * (items + 1) outputs: output group * (items + 1) + k is a value of the
// whole if k is 0, otherwise a value of item k - 1; the value of an absent item is 0.
//
//   encoding of an item = encoder(own, item)              ReLU in all layers
//   pooled = (own, maximum of the encodings, mean of the encodings)   over the items that are present
//   hidden = trunk(pooled)                                ReLU in all layers
//   values of the whole = linear(hidden)                  one for each group
//   values of an item = head(hidden, its encoding)        one for each group; linear in the last layer
//
// Outputs of permuted items are permuted outputs, to the bit, and the gradient of the parameters is the same,
// to the bit: before anything else, a column's items are put in the order of their numbers' bits. Without
// items that are present, the pooled encodings are 0.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "nn/arithmetic_kernels.h"
#include "nn/network.h"

namespace fresco {

struct SetShape {
  int own_inputs = 0;               ///< >= 1
  int items = 0;                    ///< the most items, >= 1
  int item_inputs = 0;              ///< of one item, >= 1
  int groups = 0;                   ///< >= 1
  std::vector<int> encoder_layers;  ///< units of each layer; at least one layer, each >= 1; so are the next
  std::vector<int> trunk_layers;    ///< units of each hidden layer
  std::vector<int> head_layers;     ///< units of each hidden layer
};

/// Network (nn/network.h) describes the functions. In the flat vector, encoder, trunk with the linear layer,
/// and head follow each other.
class SetNetwork : public Network {
 public:
  /// CHECKs the shape's ranges.
  explicit SetNetwork(SetShape shape);

  int inputs() const override { return shape_.own_inputs + shape_.items * shape_.item_inputs; }
  int outputs() const override { return shape_.groups * (shape_.items + 1); }
  /// Of encoder, trunk and head. The number of items is not in it.
  std::vector<int> layer_sizes() const override;
  int64_t units() const override;
  std::unique_ptr<NetworkWorkspace> NewWorkspace(int batch_capacity,
                                                 NetworkWorkspace::Passes passes) const override;
  int64_t WorkspaceBytes(int batch_capacity, NetworkWorkspace::Passes passes) const override;
  void Forward(std::span<const float> parameters, ColumnRange columns,
               NetworkWorkspace& workspace) const override;
  /// Leaves all other outputs as they were. The head computes one item of each column only.
  void ForwardUnits(std::span<const float> parameters, std::span<const int16_t> units, ColumnRange columns,
                    NetworkWorkspace& workspace) const override;
  void Transpose(std::span<const float> parameters, const ParameterPart& part,
                 NetworkWorkspace& workspace) const override;
  void BackwardColumns(const OutputGradient& output_gradient, ColumnRange columns,
                       NetworkWorkspace& workspace) const override;
  void BackwardPart(const OutputGradient& output_gradient, int batch, const ParameterPart& part,
                    NetworkWorkspace& workspace, std::span<float> gradient) const override;

 private:
  struct Workspace;
  /// Layers that follow each other.
  struct Chain {
    std::vector<int> sizes;  // number of inputs, units of each layer
    int first = 0;           // layer of the network
    int layers() const { return static_cast<int>(sizes.size()) - 1; }
    int outputs() const { return sizes.back(); }
  };

  int64_t Arrange(int batch_capacity, NetworkWorkspace::Passes passes, bool allocate,
                  Workspace& workspace) const;
  void RunChain(std::span<const float> parameters, const Chain& chain, ColumnRange columns,
                Finish last_finish, std::vector<Matrix>& activations) const;
  void RunChainBack(const Chain& chain, int layers, ColumnRange columns, const Workspace& workspace,
                    const std::vector<Matrix>& activations, std::vector<Matrix>& gradients) const;
  void Encode(std::span<const float> parameters, ColumnRange columns, Workspace& workspace) const;
  void PlaceItems(int column, Workspace& workspace) const;
  void Pool(int column, Workspace& workspace) const;
  void ValueItems(std::span<const float> parameters, ColumnRange columns, Workspace& workspace) const;
  int PlaceOf(int unit, int column, const Workspace& workspace) const;
  void Unpool(const OutputGradient& output_gradient, int column, Workspace& workspace) const;
  ColumnRange ItemColumns(ColumnRange columns) const {
    return {columns.first * shape_.items, columns.end * shape_.items};
  }
  int hidden_units() const { return trunk_.sizes[trunk_.sizes.size() - 2]; }

  SetShape shape_;
  Chain encoder_;
  Chain trunk_;  // with the linear layer
  Chain head_;
};

}  // namespace fresco
