#include <fmt/format.h>
#include <onnx/onnx_pb.h>

#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "exports/exports.h"
#include "exports/policy_parts.h"

namespace fresco {
namespace {

using onnx::TensorProto;

/// Builds a graph. Values are named; each function returns the name of the value that it adds.
class GraphWriter {
 public:
  explicit GraphWriter(onnx::GraphProto& graph) : graph_(graph) {}

  std::string Node(const std::string& operation, const std::vector<std::string>& inputs,
                   const std::string& output = "") {
    onnx::NodeProto& node = *graph_.add_node();
    node.set_op_type(operation);
    node.set_name(output.empty() ? fmt::format("v{}", ++values_) : output);
    for (const std::string& input : inputs) {
      node.add_input(input);
    }
    node.add_output(node.name());
    return node.name();
  }
  std::string NodeAlong(const std::string& operation, int64_t axis, const std::vector<std::string>& inputs,
                        const std::string& output = "") {
    const std::string name = Node(operation, inputs, output);
    AddAttribute("axis", axis);
    return name;
  }
  /// Of the node added last.
  void AddAttribute(const std::string& name, int64_t value) {
    onnx::AttributeProto& attribute = NewAttribute(name, onnx::AttributeProto::INT);
    attribute.set_i(value);
  }
  void AddAttribute(const std::string& name, const std::vector<int64_t>& values) {
    onnx::AttributeProto& attribute = NewAttribute(name, onnx::AttributeProto::INTS);
    attribute.mutable_ints()->Assign(values.begin(), values.end());
  }

  std::string Cast(const std::string& input, TensorProto::DataType type, const std::string& output = "") {
    const std::string name = Node("Cast", {input}, output);
    AddAttribute("to", int64_t{type});
    return name;
  }
  std::string Slice(const std::string& input, int first, int count) {
    return Node("Slice", {input, Integers({first}), Integers({first + count}), Integers({-1})});
  }
  std::string Reduce(const std::string& operation, const std::string& input, int64_t axis) {
    const std::string name = Node(operation, {input});
    AddAttribute("axes", std::vector{axis});
    AddAttribute("keepdims", 0);
    return name;
  }

  std::string Integers(const std::vector<int64_t>& numbers) {
    TensorProto& tensor = NewConstant(TensorProto::INT64, {static_cast<int64_t>(numbers.size())});
    tensor.mutable_int64_data()->Assign(numbers.begin(), numbers.end());
    return tensor.name();
  }
  template <class Number>
  std::string Constant(const Number* numbers, const std::vector<int64_t>& shape, Precision precision) {
    TensorProto& tensor =
        NewConstant(precision == Precision::kSingle ? TensorProto::FLOAT : TensorProto::DOUBLE, shape);
    int64_t count = 1;
    for (const int64_t size : shape) {
      count *= size;
    }
    for (int64_t i = 0; i < count; ++i) {
      if (precision == Precision::kSingle) {
        tensor.add_float_data(static_cast<float>(numbers[i]));
      } else {
        tensor.add_double_data(static_cast<double>(numbers[i]));
      }
    }
    return tensor.name();
  }

 private:
  onnx::AttributeProto& NewAttribute(const std::string& name, onnx::AttributeProto::AttributeType type) {
    onnx::AttributeProto& attribute = *graph_.mutable_node(graph_.node_size() - 1)->add_attribute();
    attribute.set_name(name);
    attribute.set_type(type);
    return attribute;
  }
  TensorProto& NewConstant(TensorProto::DataType type, const std::vector<int64_t>& shape) {
    TensorProto& tensor = *graph_.add_initializer();
    tensor.set_name(fmt::format("c{}", ++constants_));
    tensor.set_data_type(type);
    for (const int64_t size : shape) {
      tensor.add_dims(size);
    }
    return tensor;
  }

  onnx::GraphProto& graph_;
  int values_ = 0;
  int constants_ = 0;
};

TensorProto::DataType TypeOf(Precision precision) {
  return precision == Precision::kSingle ? TensorProto::FLOAT : TensorProto::DOUBLE;
}

/// Writes formulas. What depends on no state is a list [entries], everything else [batch x entries].
class FormulaWriter {
 public:
  FormulaWriter(GraphWriter& graph, const PolicyFormulas& formulas)
      : graph_(graph), formulas_(formulas.list) {
    const std::string shape = graph_.Node("Shape", {"state"});
    batch_ = graph_.Node("Gather", {shape, graph_.Integers({0})});
    for (const Formula& formula : formulas_.formulas()) {
      bool is_constant = formula.operation != Operation::kState;
      for (const int operand : formula.operands) {
        is_constant &= is_constant_[static_cast<size_t>(operand)];
      }
      is_constant_.push_back(is_constant);
      names_.push_back(formulas.used[names_.size()] ? Write(formula, is_constant) : "");
    }
  }

  /// The name of a formula's value, [batch x entries].
  std::string Batched(int index) {
    const auto at = static_cast<size_t>(index);
    if (!is_constant_[at]) {
      return names_[at];
    }
    const std::string shape =
        graph_.NodeAlong("Concat", 0, {batch_, graph_.Integers({formulas_[index].size})});
    return graph_.Node("Expand", {names_[at], shape});
  }

 private:
  std::string Write(const Formula& formula, bool is_constant) {
    std::vector<std::string> operands;
    for (const int operand : formula.operands) {
      operands.push_back(names_[static_cast<size_t>(operand)]);
    }
    switch (formula.operation) {
      case Operation::kState:
        return graph_.Slice("state", formula.first, formula.size);
      case Operation::kConstant:
        return graph_.Constant(formula.numbers.data(), {formula.size}, formula.precision);
      case Operation::kAdd:
        return graph_.Node("Add", operands);
      case Operation::kSubtract:
        return graph_.Node("Sub", operands);
      case Operation::kMultiply:
        return graph_.Node("Mul", operands);
      case Operation::kDivide:
        return graph_.Node("Div", operands);
      case Operation::kLargest:
        return graph_.Node("Max", operands);
      case Operation::kAtMost:
        return graph_.Cast(graph_.Node("LessOrEqual", operands), TypeOf(formula.precision));
      case Operation::kSquareRoot:
        return graph_.Node("Sqrt", operands);
      case Operation::kFloor:
        return graph_.Node("Floor", operands);
      case Operation::kRound:
        return graph_.Node("Round", operands);
      case Operation::kNegate:
        return graph_.Node("Neg", operands);
      case Operation::kToDouble:
      case Operation::kToSingle:
        return graph_.Cast(operands.front(), TypeOf(formula.precision));
      case Operation::kSum:
        return graph_.Node("ReduceSum", {operands.front(), graph_.Integers({-1})});
      case Operation::kChoose:
        return graph_.Node("Where", {graph_.Cast(operands[0], TensorProto::BOOL), operands[1], operands[2]});
      case Operation::kPart:
        return graph_.Slice(operands.front(), formula.first, formula.size);
      case Operation::kRow: {
        const int64_t rows = static_cast<int64_t>(formula.numbers.size()) / formula.size;
        const std::string table =
            graph_.Constant(formula.numbers.data(), {rows, formula.size}, formula.precision);
        const std::string row = graph_.Cast(operands.front(), TensorProto::INT64);
        return graph_.Node("Gather", {table, graph_.Node("Squeeze", {row, graph_.Integers({-1})})});
      }
      case Operation::kJoin:
        for (size_t i = 0; !is_constant && i < operands.size(); ++i) {
          operands[i] = Batched(formula.operands[i]);
        }
        return graph_.NodeAlong("Concat", -1, operands);
    }
    CheckFailed(__FILE_NAME__, __LINE__, "an operation of formulas.h");
  }

  GraphWriter& graph_;
  const Formulas& formulas_;
  std::string batch_;  // the batch's size
  std::vector<std::string> names_;
  std::vector<bool> is_constant_;
};

/// Writes the network.
class NetworkWriter {
 public:
  NetworkWriter(GraphWriter& graph, const StoredNetwork& network)
      : graph_(graph), parameters_(network.parameters), chains_(ChainsOf(*network.experiment.network())) {}

  /// The values of a multilayer perceptron.
  std::string Values(const std::string& observation) {
    return Run(chains_[0], 0, chains_[0].layers.size(), observation);
  }

  /// The values of a network for sets.
  std::string Values(const std::string& observation, const ObservationSets& sets) {
    const auto [own_inputs, items, item_inputs, groups] = sets;
    const std::string own = graph_.Slice(observation, 0, own_inputs);
    const std::string every_item =
        graph_.Node("Reshape", {graph_.Slice(observation, own_inputs, items * item_inputs),
                                graph_.Integers({-1, items, item_inputs})});
    const std::string present = graph_.Slice(every_item, 0, 1);  // 1 or 0
    const Chain& encoder = chains_[0];
    const std::string encodings =
        graph_.Node("Mul", {Relu(Run(encoder, 0, encoder.layers.size(),
                                     graph_.NodeAlong("Concat", -1, {ForEachItem(own, items), every_item}))),
                            present});
    const float one = 1;
    const std::string count = graph_.Node(
        "Max", {graph_.Node("ReduceSum", {graph_.Node("Squeeze", {present, graph_.Integers({-1})}),
                                          graph_.Integers({-1})}),
                graph_.Constant(&one, {1}, Precision::kSingle)});
    const std::string sum = graph_.Node("ReduceSum", {encodings, graph_.Integers({1})});
    graph_.AddAttribute("keepdims", 0);
    const std::string pooled = graph_.NodeAlong(
        "Concat", -1, {own, graph_.Reduce("ReduceMax", encodings, 1), graph_.Node("Div", {sum, count})});
    const Chain& trunk = chains_[1];
    const size_t hidden_layers = trunk.layers.size() - 1;
    const std::string hidden = Relu(Run(trunk, 0, hidden_layers, pooled));
    const std::string of_whole = Run(trunk, hidden_layers, trunk.layers.size(), hidden);
    const Chain& head = chains_[2];
    const std::string of_items =
        graph_.Node("Mul", {Run(head, 0, head.layers.size(),
                                graph_.NodeAlong("Concat", -1, {ForEachItem(hidden, items), encodings})),
                            present});
    // [batch x items x groups] and [batch x groups] become [batch x groups x (1 + items)], then one list.
    const std::string by_group = graph_.Node("Transpose", {of_items});
    graph_.AddAttribute("perm", std::vector<int64_t>{0, 2, 1});
    const std::string whole = graph_.Node("Unsqueeze", {of_whole, graph_.Integers({2})});
    return graph_.Node("Reshape", {graph_.NodeAlong("Concat", 2, {whole, by_group}),
                                   graph_.Integers({-1, groups * (items + int64_t{1})})});
  }

 private:
  /// Layers `first` to before `end` of a chain, with ReLU between them.
  std::string Run(const Chain& chain, size_t first, size_t end, std::string value) {
    for (size_t i = first; i < end; ++i) {
      const Layer& layer = chain.layers[i];
      const std::string weights = graph_.Constant(parameters_.data() + layer.weights,
                                                  {layer.inputs, layer.outputs}, Precision::kSingle);
      const std::string biases =
          graph_.Constant(parameters_.data() + layer.biases(), {layer.outputs}, Precision::kSingle);
      value =
          graph_.Node("Add", {graph_.Node("MatMul", {i == first ? value : Relu(value), weights}), biases});
    }
    return value;
  }

  std::string Relu(const std::string& value) { return graph_.Node("Relu", {value}); }

  /// [batch x n] as [batch x items x n].
  std::string ForEachItem(const std::string& value, int64_t items) {
    return graph_.Node(
        "Expand", {graph_.Node("Unsqueeze", {value, graph_.Integers({1})}), graph_.Integers({1, items, 1})});
  }

  GraphWriter& graph_;
  const Vector& parameters_;
  std::vector<Chain> chains_;
};

void Describe(onnx::ValueInfoProto& value, const std::string& name, TensorProto::DataType type, int entries) {
  value.set_name(name);
  auto& tensor = *value.mutable_type()->mutable_tensor_type();
  tensor.set_elem_type(type);
  tensor.mutable_shape()->add_dim()->set_dim_param("batch");
  if (entries > 0) {
    tensor.mutable_shape()->add_dim()->set_dim_value(entries);
  }
}

void AddMetadata(onnx::ModelProto& model, const std::string& key, const std::string& value) {
  auto& entry = *model.add_metadata_props();
  entry.set_key(key);
  entry.set_value(value);
}

/// What the fields of a state and the actions are.
void AddMetadata(onnx::ModelProto& model, const WorldDescription& world) {
  std::string fields;
  for (const Quantity& field : world.state) {
    fields += fmt::format("{}{}{}", fields.empty() ? "" : ", ", field.name,
                          field.unit.empty() ? "" : fmt::format(" ({})", field.unit));
  }
  AddMetadata(model, "world", world.name);
  AddMetadata(model, "state", fields);
  AddMetadata(model, "actions", fmt::format("{}", fmt::join(world.actions, "; ")));
}

}  // namespace

std::string OnnxModel(const StoredNetwork& network) {
  const World& world = network.experiment.world();
  const std::unique_ptr<PolicyFormulas> formulas = FormulasOf(world);
  onnx::ModelProto model;
  model.set_ir_version(7);
  model.set_producer_name("fresco");
  model.set_doc_string(PolicyTitle(network));
  model.add_opset_import()->set_version(13);
  AddMetadata(model, world.description());
  onnx::GraphProto& graph = *model.mutable_graph();
  graph.set_name("policy");
  Describe(*graph.add_input(), "state", TensorProto::FLOAT, world.state_size());
  Describe(*graph.add_output(), "action", TensorProto::INT64, 0);
  Describe(*graph.add_output(), "values", TensorProto::FLOAT, world.actions());

  GraphWriter writer(graph);
  FormulaWriter formula_writer(writer, *formulas);
  const bool has_mask = formulas->of_state.mask.has_value();
  Describe(has_mask ? *graph.add_output() : *graph.add_input(), "mask", TensorProto::BOOL, world.actions());
  if (has_mask) {
    writer.Cast(formula_writer.Batched(formulas->of_state.mask->index), TensorProto::BOOL, "mask");
  }
  const std::string observation = formula_writer.Batched(formulas->of_state.observation.index);
  NetworkWriter network_writer(writer, network);
  const bool has_sets = ChainsOf(*network.experiment.network()).size() > 1;
  writer.Node("Identity",
              {has_sets ? network_writer.Values(observation, *world.description().sets)
                        : network_writer.Values(observation)},
              "values");
  const float lowest = std::numeric_limits<float>::lowest();
  writer.NodeAlong(
      "ArgMax", 1,
      {writer.Node("Where", {"mask", "values", writer.Constant(&lowest, {1}, Precision::kSingle)})},
      "action");
  writer.AddAttribute("keepdims", 0);
  return model.SerializeAsString();
}

}  // namespace fresco
