#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string>
#include <vector>

#include "core/error.h"
#include "exports/exports.h"
#include "exports/policy_parts.h"

namespace fresco {
namespace {

constexpr const char* kUsage =
    R"(// One file, no dependencies, C++17. Act(state) is the action that Fresco takes, Observe and Values have the same
// bits as in Fresco if the compiler fuses no multiplication and addition by itself (gcc: -ffp-contract=off, which
// matters only with -march). With a processor's fused instruction (gcc: -mfma), it is several times faster.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

)";

constexpr const char* kLayer = R"(/// Weights [outputs x inputs], column by column, then biases [outputs].
template <int kInputsOfLayer, int kOutputs, bool kRelu>
inline void Layer(const float* parameters, const float* in, float* out) {
  std::copy(parameters + kInputsOfLayer * kOutputs, parameters + (kInputsOfLayer + 1) * kOutputs, out);
  for (int i = 0; i < kInputsOfLayer; ++i) {
    for (int o = 0; o < kOutputs; ++o) out[o] = std::fma(parameters[i * kOutputs + o], in[i], out[o]);
  }
  for (int o = 0; kRelu && o < kOutputs; ++o) out[o] = out[o] > 0 ? out[o] : 0.0f;
}

)";

// nn/set_network.h says what this computes.
constexpr const char* kSetNetwork = R"(
inline void RunNetwork(const float* observation, float* values) {
  const auto item_at = [&](int item) { return observation + kOwnInputs + item * kItemInputs; };
  int order[kItems];  // the items that are present, sorted by their bits
  int present = 0;
  for (int item = 0; item < kItems; ++item) {
    if (*item_at(item) == 0) continue;
    int place = present++;
    for (; place > 0 && std::memcmp(item_at(item), item_at(order[place - 1]), sizeof(float) * kItemInputs) < 0; --place) {
      order[place] = order[place - 1];
    }
    order[place] = item;
  }

  float encodings[kItems][kEncoding];  // in this order
  float pooled[kOwnInputs + 2 * kEncoding] = {};
  std::copy(observation, observation + kOwnInputs, pooled);
  float* maximum = pooled + kOwnInputs;
  float* mean = maximum + kEncoding;
  for (int place = 0; place < present; ++place) {
    float in[kOwnInputs + kItemInputs];
    const float* item = item_at(order[place]);
    std::copy(item, item + kItemInputs, std::copy(observation, observation + kOwnInputs, in));
    RunEncoder(in, encodings[place]);
    for (int i = 0; i < kEncoding; ++i) {
      maximum[i] = std::max(maximum[i], encodings[place][i]);
      mean[i] += encodings[place][i];
    }
  }
  for (int i = 0; i < kEncoding && present > 0; ++i) mean[i] /= static_cast<float>(present);

  float whole[kGroups];
  float in[kHidden + kEncoding];
  RunTrunk(pooled, whole, in);
  std::fill(values, values + kActions, 0.0f);
  for (int group = 0; group < kGroups; ++group) values[group * (kItems + 1)] = whole[group];
  for (int place = 0; place < present; ++place) {
    float of_item[kGroups];
    std::copy(encodings[place], encodings[place] + kEncoding, in + kHidden);
    RunHead(in, of_item);
    for (int group = 0; group < kGroups; ++group) values[group * (kItems + 1) + order[place] + 1] = of_item[group];
  }
}

)";

constexpr const char* kBest = R"(/// The allowed action with the largest value; of several, the first one.
inline int Best(const float* values, const bool* mask) {
  int best = -1;
  for (int action = 0; action < kActions; ++action) {
    if (mask[action] && (best < 0 || values[action] > values[best])) best = action;
  }
  return best;
}

)";

constexpr const char* kActWithMask = R"(/// The values of all actions in a state.
inline void Values(const float* state, float* values) {
  float observation[kInputs];
  Observe(state, observation);
  internal::RunNetwork(observation, values);
}

/// The action in a state; mask[a]: whether action a is allowed. At least one has to be.
inline int Act(const float* state, const bool* mask) {
  float values[kActions];
  Values(state, values);
  return internal::Best(values, mask);
}
)";

constexpr const char* kAct = R"(/// The values of all actions in a state, and whether they are allowed.
inline void Values(const float* state, float* values, bool* mask) {
  float observation[kInputs];
  Observe(state, observation, mask);
  internal::RunNetwork(observation, values);
}

/// The action in a state.
inline int Act(const float* state) {
  float values[kActions];
  bool mask[kActions];
  Values(state, values, mask);
  return internal::Best(values, mask);
}
)";

void RequireNamespace(const std::string& name) {
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; };
  const bool is_name = !name.empty() && is_letter(name.front()) && name.size() <= 63 &&
                       std::all_of(name.begin(), name.end(),
                                   [&](unsigned char c) { return is_letter(c) || std::isdigit(c) != 0; });
  if (!is_name) {
    throw UsageError(fmt::format(
        "--name: '{}' is no namespace; allowed: letters, digits and underscores, and no digit first", name));
  }
}

/// A string literal. Names have no characters that it would have to escape, but those of plug-ins might.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
    }
    quoted += c;
  }
  return quoted + '"';
}

/// "1, 2, 3", broken into lines. `suffix` follows each number.
template <class Numbers>
std::string List(const Numbers& numbers, const char* suffix) {
  std::string list;
  size_t line = 0;
  for (const auto number : numbers) {
    const std::string text = fmt::format("{:a}{}, ", number, suffix);
    if (list.size() - line + text.size() > 110) {
      list += "\n    ";
      line = list.size();
    }
    list += text;
  }
  return list;
}

/// Writes the formulas as statements, one for each.
class StatementWriter {
 public:
  explicit StatementWriter(const PolicyFormulas& formulas) : formulas_(formulas.list), used_(formulas.used) {}

  std::string All() {
    for (size_t i = 0; i < formulas_.formulas().size(); ++i) {
      if (used_[i]) {
        Write(static_cast<int>(i));
      }
    }
    return std::move(code_);
  }

 private:
  static const char* TypeOf(const Formula& formula) {
    return formula.precision == Precision::kSingle ? "float" : "double";
  }
  static const char* SuffixOf(const Formula& formula) {
    return formula.precision == Precision::kSingle ? "f" : "";
  }

  /// Entry i of an operand, which may have a single one.
  std::string Entry(const Formula& formula, size_t number) const {
    const int operand = formula.operands[number];
    return fmt::format("t{}[{}]", operand, formulas_[operand].size == 1 ? "0" : "i");
  }

  void Write(int index) {
    const Formula& formula = formulas_[index];
    const auto add = [&]<class... Values>(fmt::format_string<Values...> format, Values&&... values) {
      fmt::format_to(std::back_inserter(code_), format, std::forward<Values>(values)...);
    };
    if (formula.operation == Operation::kConstant) {
      add("  static constexpr {} t{}[{}] = {{{}}};\n", TypeOf(formula), index, formula.size,
          List(formula.numbers, SuffixOf(formula)));
      return;
    }
    if (formula.operation == Operation::kRow) {
      add("  static constexpr float table{}[] = {{\n    {}}};\n", index, List(formula.numbers, "f"));
    }
    add("  {} t{}[{}];\n", TypeOf(formula), index, formula.size);
    if (formula.operation == Operation::kJoin) {
      int next = 0;
      for (const int part : formula.operands) {
        add("  std::copy(t{0}, t{0} + {1}, t{2} + {3});\n", part, formulas_[part].size, index, next);
        next += formulas_[part].size;
      }
    } else if (formula.operation == Operation::kSum) {
      add("  t{0}[0] = 0;\n  for (int i = 0; i < {1}; ++i) t{0}[0] = t{0}[0] + t{2}[i];\n", index,
          formulas_[formula.operands[0]].size, formula.operands[0]);
    } else {
      add("  for (int i = 0; i < {}; ++i) t{}[i] = {};\n", formula.size, index, EntryOf(index));
    }
  }

  /// Entry i of the result, as an expression.
  std::string EntryOf(int index) const {
    const Formula& formula = formulas_[index];
    const auto binary = [&](const char* sign) {
      return fmt::format("{} {} {}", Entry(formula, 0), sign, Entry(formula, 1));
    };
    const auto function = [&](const char* name) { return fmt::format("{}({})", name, Entry(formula, 0)); };
    switch (formula.operation) {
      case Operation::kState:
        return fmt::format("state[{} + i]", formula.first);
      case Operation::kAdd:
        return binary("+");
      case Operation::kSubtract:
        return binary("-");
      case Operation::kMultiply:
        return binary("*");
      case Operation::kDivide:
        return binary("/");
      case Operation::kLargest:
        return fmt::format("std::max({}, {})", Entry(formula, 0), Entry(formula, 1));
      case Operation::kAtMost:
        return binary("<=") + " ? 1 : 0";
      case Operation::kSquareRoot:
        return function("std::sqrt");
      case Operation::kFloor:
        return function("std::floor");
      case Operation::kRound:
        return function("std::nearbyint");
      case Operation::kNegate:
        return "-" + Entry(formula, 0);
      case Operation::kToDouble:
        return function("static_cast<double>");
      case Operation::kToSingle:
        return function("static_cast<float>");
      case Operation::kChoose:
        return fmt::format("{} != 0 ? {} : {}", Entry(formula, 0), Entry(formula, 1), Entry(formula, 2));
      case Operation::kPart:
        return fmt::format("t{}[{} + i]", formula.operands[0], formula.first);
      case Operation::kRow:
        return fmt::format("table{}[static_cast<int>(t{}[0]) * {} + i]", index, formula.operands[0],
                           formula.size);
      case Operation::kConstant:
      case Operation::kSum:
      case Operation::kJoin:
        break;
    }
    CheckFailed(__FILE_NAME__, __LINE__, "an operation that is computed entry by entry");
  }

  const Formulas& formulas_;
  const std::vector<bool>& used_;
  std::string code_;
};

/// A function that runs a chain of layers on `in`, with ReLU between them, and writes the last one's outputs
/// to `out`; also those of the layer before it to `hidden`, if `with_hidden`.
std::string ChainFunction(const Chain& chain, bool with_hidden, bool relu_last) {
  std::string title = chain.name;
  title.front() = static_cast<char>(std::toupper(title.front()));
  std::string code = fmt::format("inline void Run{}(const float* in, float* out{}) {{\n", title,
                                 with_hidden ? ", float* hidden" : "");
  std::string below = "in";
  for (size_t i = 0; i < chain.layers.size(); ++i) {
    const Layer& layer = chain.layers[i];
    const bool is_last = i + 1 == chain.layers.size();
    const bool is_hidden = with_hidden && i + 2 == chain.layers.size();
    const std::string above = is_last ? "out" : is_hidden ? "hidden" : fmt::format("units{}", i + 1);
    if (!is_last && !is_hidden) {
      code += fmt::format("  float {}[{}];\n", above, layer.outputs);
    }
    code += fmt::format("  Layer<{}, {}, {}>(kParameters + {}, {}, {});\n", layer.inputs, layer.outputs,
                        !is_last || relu_last, layer.weights, below, above);
    below = above;
  }
  return code + "}\n\n";
}

std::string NetworkCode(const StoredNetwork& network) {
  const std::vector<Chain> chains = ChainsOf(*network.experiment.network());
  std::string code = fmt::format("inline constexpr float kParameters[{}] = {{\n    {}}};\n\n",
                                 network.parameters.size(), List(Values(network.parameters), "f"));
  if (chains.size() == 1) {
    return code + ChainFunction(chains[0], false, false);
  }
  const ObservationSets& sets = *network.experiment.world().description().sets;
  code += ChainFunction(chains[0], false, true) + ChainFunction(chains[1], true, false) +
          ChainFunction(chains[2], false, false);
  code += fmt::format(
      "inline constexpr int kOwnInputs = {};\ninline constexpr int kItems = {};\ninline constexpr int "
      "kItemInputs = {};\n"
      "inline constexpr int kGroups = {};\ninline constexpr int kEncoding = {};\ninline constexpr int "
      "kHidden = {};\n",
      sets.own_inputs, sets.items, sets.item_inputs, sets.groups, chains[0].outputs(),
      chains[1].layers.back().inputs);
  return code + kSetNetwork;
}

template <class Texts>
std::string Literals(const Texts& texts) {
  std::string list;
  for (const std::string& text : texts) {
    list += fmt::format("\n    {},", Quoted(text));
  }
  return list;
}

std::string FieldTitle(const Quantity& field) {
  return field.unit.empty() ? field.name : fmt::format("{} ({})", field.name, field.unit);
}

}  // namespace

std::string CppHeader(const StoredNetwork& network, const std::string& name) {
  RequireNamespace(name);
  const World& world = network.experiment.world();
  const std::unique_ptr<PolicyFormulas> formulas = FormulasOf(world);
  const WorldDescription& description = world.description();
  std::vector<std::string> fields;
  std::transform(description.state.begin(), description.state.end(), std::back_inserter(fields), FieldTitle);
  const std::optional<Term> mask = formulas->of_state.mask;

  std::string code = fmt::format("// A policy that was exported from Fresco: {}.\n", PolicyTitle(network));
  code += kUsage;
  code += fmt::format("namespace {} {{\n\n", name);
  code += fmt::format("inline constexpr int kStateSize = {};\ninline constexpr int kActions = {};\n",
                      fields.size(), world.actions());
  code += fmt::format("inline constexpr int kInputs = {};  // of the network\n", world.observation_size());
  code += fmt::format("inline constexpr const char* kStateFields[] = {{{}\n}};\n", Literals(fields));
  code += fmt::format("inline constexpr const char* kActionNames[] = {{{}\n}};\n\n",
                      Literals(description.actions));
  code += std::string("namespace internal {\n\n") + kLayer + NetworkCode(network) + kBest;
  code += "}  // namespace internal\n\n";
  code +=
      fmt::format("/// What the network sees of a state{}.\n", mask ? ", and which actions are allowed" : "");
  code += fmt::format("inline void Observe(const float* state, float* observation{}) {{\n",
                      mask ? ", bool* mask" : "");
  code += StatementWriter(*formulas).All();
  code +=
      fmt::format("  std::copy(t{0}, t{0} + kInputs, observation);\n", formulas->of_state.observation.index);
  if (mask) {
    code += fmt::format("  for (int i = 0; i < kActions; ++i) mask[i] = t{}[i] != 0;\n", mask->index);
  }
  code += std::string("}\n\n") + (mask ? kAct : kActWithMask);
  return code + fmt::format("\n}}  // namespace {}\n", name);
}

}  // namespace fresco
