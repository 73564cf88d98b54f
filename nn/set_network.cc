#include "nn/set_network.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "core/error.h"
#include "nn/arithmetic.h"
#include "nn/layers.h"

namespace fresco {
namespace {

bool AllPositive(const std::vector<int>& sizes) {
  return !sizes.empty() && std::all_of(sizes.begin(), sizes.end(), [](int size) { return size >= 1; });
}

const SetShape& Checked(const SetShape& shape) {
  FRESCO_CHECK(AllPositive({shape.own_inputs, shape.items, shape.item_inputs, shape.groups}));
  FRESCO_CHECK(AllPositive(shape.encoder_layers) && AllPositive(shape.trunk_layers) &&
               AllPositive(shape.head_layers));
  return shape;
}

std::vector<int> Joined(int inputs, std::vector<int> units) {
  units.insert(units.begin(), inputs);
  return units;
}

std::vector<int> EncoderSizes(const SetShape& shape) {
  return Joined(shape.own_inputs + shape.item_inputs, shape.encoder_layers);
}

std::vector<int> TrunkSizes(const SetShape& shape) {
  std::vector<int> sizes = Joined(shape.own_inputs + 2 * shape.encoder_layers.back(), shape.trunk_layers);
  sizes.push_back(shape.groups);
  return sizes;
}

std::vector<int> HeadSizes(const SetShape& shape) {
  std::vector<int> sizes = Joined(shape.trunk_layers.back() + shape.encoder_layers.back(), shape.head_layers);
  sizes.push_back(shape.groups);
  return sizes;
}

std::vector<Layer> SetLayers(const SetShape& shape) {
  std::vector<Layer> layers;
  int64_t next = 0;
  for (const std::vector<int>& sizes : {EncoderSizes(shape), TrunkSizes(shape), HeadSizes(shape)}) {
    for (size_t i = 0; i + 1 < sizes.size(); ++i) {
      layers.push_back({sizes[i], sizes[i + 1], next});
      next = layers.back().end();
    }
  }
  return layers;
}

// What pooling does with each encoding of one item. Each loop is one that compilers turn into vector
// instructions.

void TakeLargest(int count, const float* __restrict encoding, int place, float* __restrict maximum,
                 int* __restrict largest) {
  for (int i = 0; i < count; ++i) {
    largest[i] ^= (largest[i] ^ place) & -static_cast<int>(encoding[i] > maximum[i]);
  }
  for (int i = 0; i < count; ++i) {
    maximum[i] = encoding[i] > maximum[i] ? encoding[i] : maximum[i];
  }
}

void Divide(int count, int divisor, float* values) {
  for (int i = 0; i < count && divisor > 0; ++i) {
    values[i] /= static_cast<float>(divisor);
  }
}

void GradientOfPools(int count, const float* __restrict encoding, int place, const int* __restrict largest,
                     const float* __restrict of_maximum, const float* __restrict of_mean,
                     float* __restrict gradient) {
  for (int i = 0; i < count; ++i) {
    gradient[i] = largest[i] == place ? of_maximum[i] : 0.0f;
  }
  for (int i = 0; i < count; ++i) {
    gradient[i] += of_mean[i];
  }
  for (int i = 0; i < count; ++i) {
    gradient[i] = encoding[i] > 0 ? gradient[i] : 0.0f;
  }
}

/// Calls function(block) for columns that go through a chain together.
template <class Function>
void ForEachBlock(ColumnRange columns, Function function) {
  for (int column = columns.first; column < columns.end; column += kColumnsAtOnce) {
    function(ColumnRange{column, std::min(column + kColumnsAtOnce, columns.end)});
  }
}

}  // namespace

/// In the matrices of items, column c of the batch has the columns from c * items on. Its present items come
/// first, each at its place. The columns of all layers begin at the cache's lines.
struct SetNetwork::Workspace : NetworkWorkspace {
  Matrix& input() override { return observations; }
  const Matrix& output() const override { return values; }

  Matrix observations;
  Matrix values;
  // Activations: [0] is a chain's input, [l + 1] the output of its layer l.
  std::vector<Matrix> encoder;     // of items
  std::vector<Matrix> trunk;       // by column
  std::vector<Matrix> item_heads;  // of items, for all outputs; [0] is empty
  std::vector<Matrix> head;        // by column, for one output of each; input 0 for a value of the whole
  Matrix head_beginning;           // by column: what the head's first layer has from the trunk
  std::vector<int> present;        // by column: number of items that are present
  std::vector<int> places;         // by column and item: the column of items that has it; -1: it is absent
  std::vector<int> order;          // by column and place: the item
  std::vector<int> largest;        // by column and encoding: the place of the item that has the maximum
  // For the backward pass: d loss / d activations before ReLU, and the weights of each layer but the
  // encoder's first one, [inputs x outputs].
  std::vector<Matrix> encoder_gradients;  // [0] is empty
  std::vector<Matrix> trunk_gradients;
  std::vector<Matrix> head_gradients;
  std::vector<Matrix> transposed;
};

SetNetwork::SetNetwork(SetShape shape)
    : Network(SetLayers(Checked(shape))),
      shape_(std::move(shape)),
      encoder_{EncoderSizes(shape_), 0},
      trunk_{TrunkSizes(shape_), encoder_.layers()},
      head_{HeadSizes(shape_), trunk_.first + trunk_.layers()} {}

std::vector<int> SetNetwork::layer_sizes() const {
  std::vector<int> sizes = encoder_.sizes;
  for (const Chain* chain : {&trunk_, &head_}) {
    sizes.push_back(0);
    sizes.insert(sizes.end(), chain->sizes.begin(), chain->sizes.end());
  }
  return sizes;
}

int64_t SetNetwork::units() const {
  const auto sum = [](const Chain& chain) {
    return std::accumulate(chain.sizes.begin(), chain.sizes.end(), int64_t{0});
  };
  return inputs() + outputs() + sum(trunk_) + shape_.items * (sum(encoder_) + sum(head_));
}

/// Gives the workspace's members their sizes, or only counts them. Returns the number of entries, four bytes
/// each.
int64_t SetNetwork::Arrange(int batch_capacity, NetworkWorkspace::Passes passes, bool allocate,
                            Workspace& workspace) const {
  FRESCO_CHECK(batch_capacity >= 1);
  int64_t entries = 0;
  const auto matrix = [&](Matrix& to, int rows, int64_t columns) {
    entries += rows * columns;
    if (allocate) {
      to = Matrix::Zero(rows, columns);
    }
  };
  const auto numbers = [&](std::vector<int>& to, int64_t count) {
    entries += count;
    to.resize(allocate ? static_cast<size_t>(count) : 0);
  };
  const auto chain = [&](std::vector<Matrix>& to, const std::vector<int>& sizes, int64_t columns,
                         size_t first) {
    to.resize(sizes.size());
    for (size_t i = first; i < sizes.size(); ++i) {
      matrix(to[i], PaddedRows(sizes[i]), columns);
    }
  };
  const int64_t item_columns = int64_t{batch_capacity} * shape_.items;
  matrix(workspace.observations, inputs(), batch_capacity);
  matrix(workspace.values, outputs(), batch_capacity);
  chain(workspace.encoder, encoder_.sizes, item_columns, 0);
  chain(workspace.trunk, trunk_.sizes, batch_capacity, 0);
  chain(workspace.item_heads, head_.sizes, item_columns, 1);
  chain(workspace.head, head_.sizes, batch_capacity, 0);
  matrix(workspace.head_beginning, PaddedRows(head_.sizes[1]), batch_capacity);
  numbers(workspace.present, batch_capacity);
  numbers(workspace.places, item_columns);
  numbers(workspace.order, item_columns);
  numbers(workspace.largest, int64_t{batch_capacity} * encoder_.outputs());
  if (passes == NetworkWorkspace::Passes::kForwardAndBackward) {
    chain(workspace.encoder_gradients, encoder_.sizes, item_columns, 1);
    chain(workspace.trunk_gradients, trunk_.sizes, batch_capacity, 0);
    chain(workspace.head_gradients, head_.sizes, batch_capacity, 0);
    workspace.transposed.resize(layers().size());
    for (size_t i = 1; i < layers().size(); ++i) {
      matrix(workspace.transposed[i], PaddedRows(layers()[i].inputs), layers()[i].outputs);
    }
  }
  return entries;
}

std::unique_ptr<NetworkWorkspace> SetNetwork::NewWorkspace(int batch_capacity,
                                                           NetworkWorkspace::Passes passes) const {
  auto workspace = std::make_unique<Workspace>();
  Arrange(batch_capacity, passes, true, *workspace);
  return workspace;
}

int64_t SetNetwork::WorkspaceBytes(int batch_capacity, NetworkWorkspace::Passes passes) const {
  static_assert(sizeof(Matrix::Scalar) == sizeof(int));
  Workspace workspace;
  return Arrange(batch_capacity, passes, false, workspace) * static_cast<int64_t>(sizeof(int));
}

void SetNetwork::Forward(std::span<const float> parameters, ColumnRange columns,
                         NetworkWorkspace& network_workspace) const {
  auto& workspace = static_cast<Workspace&>(network_workspace);
  Encode(parameters, columns, workspace);
  ValueItems(parameters, columns, workspace);
  for (int column = columns.first; column < columns.end; ++column) {
    const int* places = workspace.places.data() + int64_t{column} * shape_.items;
    float* value = workspace.values.col(column).data();
    for (int group = 0; group < shape_.groups; ++group) {
      *value++ = workspace.trunk.back()(group, column);
      for (int item = 0; item < shape_.items; ++item) {
        *value++ = places[item] < 0 ? 0.0f : workspace.item_heads.back()(group, places[item]);
      }
    }
  }
}

void SetNetwork::ForwardUnits(std::span<const float> parameters, std::span<const int16_t> units,
                              ColumnRange columns, NetworkWorkspace& network_workspace) const {
  auto& workspace = static_cast<Workspace&>(network_workspace);
  Encode(parameters, columns, workspace);
  for (int column = columns.first; column < columns.end; ++column) {
    const int place = PlaceOf(units[static_cast<size_t>(column)], column, workspace);
    float* input = workspace.head.front().col(column).data();
    if (place < 0) {
      std::fill_n(input, head_.sizes.front(), 0.0f);
      continue;
    }
    const float* hidden = workspace.trunk[workspace.trunk.size() - 2].col(column).data();
    std::copy_n(workspace.encoder.back().col(place).data(), encoder_.outputs(),
                std::copy_n(hidden, hidden_units(), input));
  }
  RunChain(parameters, head_, columns, Finish::kNothing, workspace.head);
  for (int column = columns.first; column < columns.end; ++column) {
    const int unit = units[static_cast<size_t>(column)];
    const int group = unit / (shape_.items + 1);
    const bool of_whole = unit % (shape_.items + 1) == 0;
    const bool absent = !of_whole && PlaceOf(unit, column, workspace) < 0;
    workspace.values(unit, column) =
        absent ? 0.0f : (of_whole ? workspace.trunk : workspace.head).back()(group, column);
  }
}

/// The column of items that has the item of an output; -1 if it is absent or the output is of the whole.
int SetNetwork::PlaceOf(int unit, int column, const Workspace& workspace) const {
  const int k = unit % (shape_.items + 1);
  return k == 0 ? -1
                : workspace.places[static_cast<size_t>(column) * static_cast<size_t>(shape_.items) +
                                   static_cast<size_t>(k) - 1];
}

void SetNetwork::RunChain(std::span<const float> parameters, const Chain& chain, ColumnRange columns,
                          Finish last_finish, std::vector<Matrix>& activations) const {
  const Arithmetic& arithmetic = CurrentArithmetic();
  ForEachBlock(columns, [&](ColumnRange block) {
    for (int i = 0; i < chain.layers(); ++i) {
      const auto at = static_cast<size_t>(i);
      arithmetic.multiply(ForwardProduct(parameters, layer(chain.first + i), activations[at], block,
                                         i + 1 < chain.layers() ? Finish::kRelu : last_finish,
                                         activations[at + 1]));
    }
  });
}

/// Everything but the values of items.
void SetNetwork::Encode(std::span<const float> parameters, ColumnRange columns, Workspace& workspace) const {
  FRESCO_CHECK(static_cast<int64_t>(parameters.size()) == parameter_count());
  FRESCO_CHECK(columns.first >= 0 && columns.end <= workspace.observations.cols());
  for (int column = columns.first; column < columns.end; ++column) {
    PlaceItems(column, workspace);
  }
  RunChain(parameters, encoder_, ItemColumns(columns), Finish::kRelu, workspace.encoder);
  for (int column = columns.first; column < columns.end; ++column) {
    Pool(column, workspace);
  }
  RunChain(parameters, trunk_, columns, Finish::kNothing, workspace.trunk);
}

/// Writes the encoder's input: the present items in the order of their bits. Items of equal bits have the
/// place of the first one of them.
void SetNetwork::PlaceItems(int column, Workspace& workspace) const {
  const float* own = workspace.observations.col(column).data();
  const auto item_at = [&](int item) { return own + shape_.own_inputs + int64_t{item} * shape_.item_inputs; };
  const auto less = [&, bytes = sizeof(float) * static_cast<size_t>(shape_.item_inputs)](int a, int b) {
    return std::memcmp(item_at(a), item_at(b), bytes) < 0;
  };
  const int first_place = column * shape_.items;
  int* order = workspace.order.data() + first_place;
  int* places = workspace.places.data() + first_place;
  int present = 0;
  for (int item = 0; item < shape_.items; ++item) {
    places[item] = -1;
    if (*item_at(item) != 0) {
      order[present++] = item;
    }
  }
  std::sort(order, order + present, less);
  workspace.present[static_cast<size_t>(column)] = present;
  for (int place = 0; place < shape_.items; ++place) {
    float* input = workspace.encoder.front().col(first_place + place).data();
    if (place >= present) {
      std::fill_n(input, encoder_.sizes.front(), 0.0f);
      continue;
    }
    const int item = order[place];
    std::copy_n(item_at(item), shape_.item_inputs, std::copy_n(own, shape_.own_inputs, input));
    const bool equal = place > 0 && !less(order[place - 1], item);
    places[item] = equal ? places[order[place - 1]] : first_place + place;
  }
}

/// Writes the trunk's input.
void SetNetwork::Pool(int column, Workspace& workspace) const {
  const int encodings = encoder_.outputs();
  const int present = workspace.present[static_cast<size_t>(column)];
  float* maximum = std::copy_n(workspace.observations.col(column).data(), shape_.own_inputs,
                               workspace.trunk.front().col(column).data());
  float* mean = maximum + encodings;
  int* largest = workspace.largest.data() + int64_t{column} * encodings;
  std::fill_n(maximum, 2 * encodings, 0.0f);
  std::fill_n(largest, encodings, -1);
  for (int place = 0; place < present; ++place) {
    const float* encoding = workspace.encoder.back().col(column * shape_.items + place).data();
    TakeLargest(encodings, encoding, place, maximum, largest);
    CurrentArithmetic().add_scaled(encodings, 1.0f, encoding, mean);
  }
  Divide(encodings, present, mean);
}

/// The head of all items. Its first layer computes the terms of the trunk once for each column, and goes on
/// from there for each item, which gives the same bits as one product.
void SetNetwork::ValueItems(std::span<const float> parameters, ColumnRange columns,
                            Workspace& workspace) const {
  const Arithmetic& arithmetic = CurrentArithmetic();
  const Layer& first = layer(head_.first);
  ForEachBlock(columns, [&](ColumnRange block) {
    Product product = ForwardProduct(parameters, first, workspace.trunk[workspace.trunk.size() - 2], block,
                                     Finish::kNothing, workspace.head_beginning);
    product.inner = hidden_units();
    arithmetic.multiply(product);
  });
  ForEachBlock(ItemColumns(columns), [&](ColumnRange block) {
    Matrix& above = workspace.item_heads[1];
    for (int place = block.first; place < block.end; ++place) {
      std::copy_n(workspace.head_beginning.col(place / shape_.items).data(), first.outputs,
                  above.col(place).data());
    }
    Product product =
        ForwardProduct(parameters, first, workspace.encoder.back(), block, Finish::kRelu, above);
    product.a += int64_t{hidden_units()} * first.outputs;
    product.inner = encoder_.outputs();
    product.bias = product.result;
    product.bias_stride = product.result_stride;
    arithmetic.multiply(product);
    for (int i = 1; i < head_.layers(); ++i) {
      const auto at = static_cast<size_t>(i);
      arithmetic.multiply(ForwardProduct(parameters, layer(head_.first + i), workspace.item_heads[at], block,
                                         i + 1 < head_.layers() ? Finish::kRelu : Finish::kNothing,
                                         workspace.item_heads[at + 1]));
    }
  });
}

void SetNetwork::Transpose(std::span<const float> parameters, const ParameterPart& part,
                           NetworkWorkspace& workspace) const {
  if (part.layer > 0) {  // nobody needs the gradient of the network's input
    TransposePart(parameters, layer(part.layer), part,
                  static_cast<Workspace&>(workspace).transposed[static_cast<size_t>(part.layer)]);
  }
}

/// From the outputs of the chain's first `layers` layers to its input, or that of its layer 1 if it has no
/// gradient of its input.
void SetNetwork::RunChainBack(const Chain& chain, int layers, ColumnRange columns, const Workspace& workspace,
                              const std::vector<Matrix>& activations, std::vector<Matrix>& gradients) const {
  const int lowest = gradients.front().size() == 0 ? 1 : 0;
  ForEachBlock(columns, [&](ColumnRange block) {
    for (int i = layers - 1; i >= lowest; --i) {
      const auto at = static_cast<size_t>(i);
      CurrentArithmetic().multiply(BackwardProduct(layer(chain.first + i),
                                                   workspace.transposed[static_cast<size_t>(chain.first + i)],
                                                   gradients[at + 1], block, activations[at], gradients[at]));
    }
  });
}

void SetNetwork::BackwardColumns(const OutputGradient& output_gradient, ColumnRange columns,
                                 NetworkWorkspace& network_workspace) const {
  auto& workspace = static_cast<Workspace&>(network_workspace);
  for (int column = columns.first; column < columns.end; ++column) {
    const int unit = output_gradient.units[static_cast<size_t>(column)];
    workspace.trunk_gradients.back().col(column).setZero();
    workspace.head_gradients.back().col(column).setZero();
    const bool of_whole = unit % (shape_.items + 1) == 0;
    if (of_whole || PlaceOf(unit, column, workspace) >= 0) {
      (of_whole ? workspace.trunk_gradients : workspace.head_gradients)
          .back()(unit / (shape_.items + 1), column) = output_gradient.values[static_cast<size_t>(column)];
    }
  }
  RunChainBack(head_, head_.layers(), columns, workspace, workspace.head, workspace.head_gradients);
  const int last = trunk_.layers() - 1;
  ForEachBlock(columns, [&](ColumnRange block) {
    // The trunk's hidden units get theirs from the linear layer and from the head.
    const auto at = static_cast<size_t>(last);
    Product product = BackwardProduct(
        layer(trunk_.first + last), workspace.transposed[static_cast<size_t>(trunk_.first + last)],
        workspace.trunk_gradients[at + 1], block, workspace.trunk[at], workspace.trunk_gradients[at]);
    product.bias = workspace.head_gradients.front().col(block.first).data();
    product.bias_stride = workspace.head_gradients.front().rows();
    CurrentArithmetic().multiply(product);
  });
  RunChainBack(trunk_, last, columns, workspace, workspace.trunk, workspace.trunk_gradients);
  for (int column = columns.first; column < columns.end; ++column) {
    Unpool(output_gradient, column, workspace);
  }
  RunChainBack(encoder_, encoder_.layers(), ItemColumns(columns), workspace, workspace.encoder,
               workspace.encoder_gradients);
}

/// The gradient of a column's encodings: from the maximum, from the mean, and from the head of one item.
void SetNetwork::Unpool(const OutputGradient& output_gradient, int column, Workspace& workspace) const {
  const int encodings = encoder_.outputs();
  const int present = workspace.present[static_cast<size_t>(column)];
  const int of_head = PlaceOf(output_gradient.units[static_cast<size_t>(column)], column, workspace);
  const float* of_maximum = workspace.trunk_gradients.front().col(column).data() + shape_.own_inputs;
  float* of_mean = workspace.trunk_gradients.front().col(column).data() + shape_.own_inputs + encodings;
  const int* largest = workspace.largest.data() + int64_t{column} * encodings;
  Divide(encodings, present, of_mean);
  for (int place = 0; place < shape_.items; ++place) {
    const int at = column * shape_.items + place;
    float* gradient = workspace.encoder_gradients.back().col(at).data();
    if (place >= present) {
      std::fill_n(gradient, encodings, 0.0f);
      continue;
    }
    GradientOfPools(encodings, workspace.encoder.back().col(at).data(), place, largest, of_maximum, of_mean,
                    gradient);
    if (at == of_head) {
      CurrentArithmetic().add_scaled(
          encodings, 1.0f, workspace.head_gradients.front().col(column).data() + hidden_units(), gradient);
    }
  }
}

void SetNetwork::BackwardPart(const OutputGradient&, int batch, const ParameterPart& part,
                              NetworkWorkspace& network_workspace, std::span<float> gradient) const {
  FRESCO_CHECK(static_cast<int64_t>(gradient.size()) == part.size());
  auto& workspace = static_cast<Workspace&>(network_workspace);
  const auto of_chain = [&](const Chain& chain, const std::vector<Matrix>& activations,
                            const std::vector<Matrix>& gradients, int columns) {
    const auto at = static_cast<size_t>(part.layer - chain.first);
    PartGradient(layer(part.layer), part, gradients[at + 1], activations[at], columns, gradient);
  };
  if (part.layer >= head_.first) {
    of_chain(head_, workspace.head, workspace.head_gradients, batch);
  } else if (part.layer >= trunk_.first) {
    of_chain(trunk_, workspace.trunk, workspace.trunk_gradients, batch);
  } else {
    of_chain(encoder_, workspace.encoder, workspace.encoder_gradients, batch * shape_.items);
  }
}

}  // namespace fresco
