// Forward against plain loops in double precision; gradients against central finite differences of them. The
// order of the items, absent items and the rest of the batch change no bit.
#include "nn/set_network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "nn/arithmetic.h"
#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

using Passes = NetworkWorkspace::Passes;
using Observations = std::vector<std::vector<float>>;

constexpr int kSetBatch = 11;

/// A batch with the output of each column that has a gradient.
struct SetBatch {
  Observations observations;
  std::vector<int16_t> units;
  std::vector<float> values;
};

class SetNetworkTest : public ::testing::TestWithParam<SetShape> {
 protected:
  SetNetworkTest() : parameters_(network_.InitialParameters(5)) {
    for (int64_t i = 0; i < parameters_.size(); ++i) {  // biases, too
      parameters_(i) += static_cast<float>(0.2 * stream_.NextUniform() - 0.1);
    }
    for (int column = 0; column < kSetBatch; ++column) {
      batch_.observations.push_back(RandomObservation(column));
      batch_.units.push_back(
          static_cast<int16_t>(stream_.NextBelow(static_cast<uint32_t>(network_.outputs()))));
    }
    batch_.values = RandomFloats(stream_, kSetBatch, 1);
  }

  int FirstOfItem(int item) const { return shape().own_inputs + item * shape().item_inputs; }

  /// Every third observation has all items, every third none, the others some; the last two of all items are
  /// alike.
  std::vector<float> RandomObservation(int column) {
    std::vector<float> observation = RandomFloats(stream_, static_cast<size_t>(network_.inputs()), 1);
    for (int item = 0; item < shape().items; ++item) {
      const bool present = column % 3 == 0 || (column % 3 == 1 && stream_.NextBelow(2) == 0);
      observation[static_cast<size_t>(FirstOfItem(item))] = present ? 1 : 0;
    }
    if (column % 3 == 0 && shape().items > 1) {
      std::copy_n(observation.end() - 2 * shape().item_inputs, shape().item_inputs,
                  observation.end() - shape().item_inputs);
    }
    return observation;
  }

  static const SetShape& shape() { return GetParam(); }

  std::unique_ptr<NetworkWorkspace> WorkspaceFor(const Observations& observations, int capacity = kSetBatch) {
    auto workspace = network_.NewWorkspace(capacity, Passes::kForwardAndBackward);
    workspace->input().setConstant(std::numeric_limits<float>::quiet_NaN());
    for (size_t column = 0; column < observations.size(); ++column) {
      SetColumn(*workspace, static_cast<int>(column), observations[column]);
    }
    return workspace;
  }

  /// The outputs of a batch, one column after the other.
  std::vector<float> Outputs(const Observations& observations) {
    const auto workspace = WorkspaceFor(observations);
    const auto columns = static_cast<int>(observations.size());
    network_.Forward(Values(parameters_), {0, columns}, *workspace);
    const float* first = workspace->output().data();
    return {first, first + int64_t{columns} * network_.outputs()};
  }

  /// The gradient by passes that go through columns and parts in these steps, the last ones first.
  std::vector<float> Gradient(const SetBatch& batch, int columns_at_once = kSetBatch) {
    const auto workspace = WorkspaceFor(batch.observations);
    std::vector<float> gradient(static_cast<size_t>(parameters_.size()), 123.0f);
    const OutputGradient output_gradient{batch.units, batch.values};
    for (const ParameterPart& part : network_.parts()) {
      network_.Transpose(Values(parameters_), part, *workspace);
    }
    for (int end = kSetBatch; end > 0; end -= columns_at_once) {
      const ColumnRange columns{std::max(0, end - columns_at_once), end};
      network_.ForwardUnits(Values(parameters_), batch.units, columns, *workspace);
      network_.BackwardColumns(output_gradient, columns, *workspace);
    }
    std::for_each(network_.parts().rbegin(), network_.parts().rend(), [&](const ParameterPart& part) {
      network_.BackwardPart(
          output_gradient, kSetBatch, part, *workspace,
          std::span(gradient).subspan(static_cast<size_t>(part.first), static_cast<size_t>(part.size())));
    });
    return gradient;
  }

  Doubles LiteralOutputs(const Doubles& parameters, size_t column) const {
    const std::vector<float>& observation = batch_.observations[column];
    return LiteralForward(shape(), parameters, Doubles(observation.begin(), observation.end()));
  }

  /// A loss that is linear in one output of each column, so that its gradient there is batch_.values.
  double LiteralLoss(const Doubles& parameters) const {
    double loss = 0;
    for (size_t column = 0; column < kSetBatch; ++column) {
      loss += LiteralOutputs(parameters, column)[static_cast<size_t>(batch_.units[column])] *
              static_cast<double>(batch_.values[column]);
    }
    return loss;
  }

  Doubles WideParameters() const { return {parameters_.data(), parameters_.data() + parameters_.size()}; }

  /// The observation with item `order[i]` as item i.
  std::vector<float> Permuted(const std::vector<float>& observation, const std::vector<int>& order) const {
    std::vector<float> permuted = observation;
    for (int item = 0; item < shape().items; ++item) {
      std::copy_n(observation.begin() + FirstOfItem(order[static_cast<size_t>(item)]), shape().item_inputs,
                  permuted.begin() + FirstOfItem(item));
    }
    return permuted;
  }

  std::vector<int> RandomOrder() {
    std::vector<int> order(static_cast<size_t>(shape().items));
    std::iota(order.begin(), order.end(), 0);
    for (size_t i = order.size(); i > 1; --i) {
      std::swap(order[i - 1], order[stream_.NextBelow(static_cast<uint32_t>(i))]);
    }
    return order;
  }

  /// The output that has the value of `unit` once the items are permuted.
  int16_t Permuted(int16_t unit, const std::vector<int>& order) const {
    const int k = unit % (shape().items + 1);
    const auto place = std::find(order.begin(), order.end(), k - 1) - order.begin();
    return static_cast<int16_t>(k == 0 ? unit : unit - k + 1 + static_cast<int>(place));
  }

  RandomStream stream_{7, RandomPurpose::kTest, 0, 0};
  SetNetwork network_{GetParam()};
  Vector parameters_;
  SetBatch batch_;
};

TEST_P(SetNetworkTest, ForwardIsThatOfPlainLoops) {
  const std::vector<float> outputs = Outputs(batch_.observations);
  Doubles expected;
  for (size_t column = 0; column < kSetBatch; ++column) {
    const Doubles of_column = LiteralOutputs(WideParameters(), column);
    expected.insert(expected.end(), of_column.begin(), of_column.end());
  }
  ASSERT_EQ(outputs.size(), expected.size());
  for (size_t i = 0; i < outputs.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(outputs[i]), expected[i], 2e-5) << i;
  }
}

TEST_P(SetNetworkTest, OneOutputOfEachColumnHasTheBitsOfAllOutputs) {
  const std::vector<float> outputs = Outputs(batch_.observations);
  const auto workspace = WorkspaceFor(batch_.observations);
  network_.ForwardUnits(Values(parameters_), batch_.units, {0, kSetBatch}, *workspace);
  for (int column = 0; column < kSetBatch; ++column) {
    const int unit = batch_.units[static_cast<size_t>(column)];
    EXPECT_EQ(workspace->output()(unit, column),
              outputs[static_cast<size_t>(column * network_.outputs() + unit)]);
  }
}

TEST_P(SetNetworkTest, BackwardIsTheFiniteDifferenceOfTheLoss) {
  const std::vector<float> gradient = Gradient(batch_);
  constexpr double kStep = 1e-6;
  Doubles parameters = WideParameters();
  const size_t stride = parameters.size() / 400 + 1;
  for (size_t i = 0; i < parameters.size(); i += stride) {
    const double value = parameters[i];
    parameters[i] = value + kStep;
    const double above = LiteralLoss(parameters);
    parameters[i] = value - kStep;
    const double below = LiteralLoss(parameters);
    parameters[i] = value;
    EXPECT_NEAR(static_cast<double>(gradient[i]), (above - below) / (2 * kStep), 2e-4) << "parameter " << i;
  }
}

TEST_P(SetNetworkTest, BitsDoNotDependOnHowColumnsAreDivided) {
  const std::vector<float> together = Gradient(batch_);
  for (const int columns_at_once : {1, 2, 3, 8}) {
    EXPECT_EQ(Gradient(batch_, columns_at_once), together) << columns_at_once;
  }
}

TEST_P(SetNetworkTest, OutputsOfAnObservationDoNotDependOnItsBatch) {
  const std::vector<float> together = Outputs(batch_.observations);
  for (int column = 0; column < kSetBatch; ++column) {
    const auto first = together.begin() + int64_t{column} * network_.outputs();
    EXPECT_EQ(Outputs({batch_.observations[static_cast<size_t>(column)]}),
              std::vector<float>(first, first + network_.outputs()));
  }
}

TEST_P(SetNetworkTest, PermutedItemsHavePermutedValuesAndTheSameGradientToTheBit) {
  const std::vector<float> outputs = Outputs(batch_.observations);
  const std::vector<float> gradient = Gradient(batch_);
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<int> order = RandomOrder();
    SetBatch permuted = batch_;
    for (size_t column = 0; column < kSetBatch; ++column) {
      permuted.observations[column] = Permuted(batch_.observations[column], order);
      permuted.units[column] = Permuted(batch_.units[column], order);
    }
    const std::vector<float> permuted_outputs = Outputs(permuted.observations);
    for (int i = 0; i < kSetBatch * network_.outputs(); ++i) {
      const int column = i / network_.outputs();
      const auto unit = static_cast<int16_t>(i % network_.outputs());
      ASSERT_EQ(permuted_outputs[static_cast<size_t>(column * network_.outputs() + Permuted(unit, order))],
                outputs[static_cast<size_t>(i)]);
    }
    ASSERT_EQ(Gradient(permuted), gradient);
  }
}

TEST_P(SetNetworkTest, AbsentItemsDoNotMatter) {
  const std::vector<float> outputs = Outputs(batch_.observations);
  const std::vector<float> gradient = Gradient(batch_);
  SetBatch other = batch_;
  for (std::vector<float>& observation : other.observations) {
    for (int item = 0; item < shape().items; ++item) {
      const auto first = observation.begin() + FirstOfItem(item);
      if (*first == 0) {
        std::fill_n(first + 1, shape().item_inputs - 1, std::numeric_limits<float>::quiet_NaN());
      }
    }
  }
  EXPECT_EQ(Outputs(other.observations), outputs);
  EXPECT_EQ(Gradient(other), gradient);
}

TEST_P(SetNetworkTest, TakesMoreItemsWithTheSameParameters) {
  SetShape larger = shape();
  larger.items += 3;
  const SetNetwork more(larger);
  EXPECT_EQ(more.layer_sizes(), network_.layer_sizes());
  const auto workspace = more.NewWorkspace(kSetBatch, Passes::kForward);
  for (int column = 0; column < kSetBatch; ++column) {
    std::vector<float> observation = batch_.observations[static_cast<size_t>(column)];
    observation.resize(static_cast<size_t>(more.inputs()), 0.0f);
    SetColumn(*workspace, column, observation);
  }
  more.Forward(Values(parameters_), {0, kSetBatch}, *workspace);
  const std::vector<float> outputs = Outputs(batch_.observations);
  for (int i = 0; i < kSetBatch * network_.outputs(); ++i) {
    const int unit = i % network_.outputs();
    const int of_more = unit / (shape().items + 1) * (larger.items + 1) + unit % (shape().items + 1);
    EXPECT_EQ(workspace->output()(of_more, i / network_.outputs()), outputs[static_cast<size_t>(i)]);
  }
}

TEST_P(SetNetworkTest, EveryArithmeticGivesTheSameBits) {
  const std::string fastest = CurrentArithmetic().name;
  const std::vector<float> outputs = Outputs(batch_.observations);
  const std::vector<float> gradient = Gradient(batch_);
  for (const Arithmetic* arithmetic : AvailableArithmetics()) {
    UseArithmetic(arithmetic->name);
    EXPECT_EQ(Outputs(batch_.observations), outputs) << arithmetic->name;
    EXPECT_EQ(Gradient(batch_), gradient) << arithmetic->name;
  }
  UseArithmetic(fastest);
}

TEST_P(SetNetworkTest, PartsAreAllParametersOnce) {
  int64_t next = 0;
  for (const ParameterPart& part : network_.parts()) {
    EXPECT_EQ(part.first, next);
    EXPECT_GT(part.end, part.first);
    next = part.end;
  }
  EXPECT_EQ(next, network_.parameter_count());
}

INSTANTIATE_TEST_SUITE_P(Shapes, SetNetworkTest,
                         ::testing::Values(SetShape{3, 4, 5, 2, {8}, {9}, {7}},
                                           SetShape{1, 1, 1, 1, {3}, {4}, {2}},
                                           SetShape{6, 7, 7, 5, {64, 64}, {128, 128}, {64}},
                                           SetShape{2, 60, 3, 4, {17, 5, 9}, {33}, {12, 6}}));

TEST(SetNetwork, HasLayersOfTheSizesByHand) {
  const SetNetwork network({2, 3, 4, 5, {6, 7}, {8}, {9}});
  // 2 + 4 inputs of the encoder; 2 + 7 + 7 of the trunk; 8 + 7 of the head.
  EXPECT_EQ(network.layer_sizes(), (std::vector<int>{6, 6, 7, 0, 16, 8, 5, 0, 15, 9, 5}));
  EXPECT_EQ(network.parameter_count(),
            (6 + 1) * 6 + (6 + 1) * 7 + (16 + 1) * 8 + (8 + 1) * 5 + (15 + 1) * 9 + (9 + 1) * 5);
  EXPECT_EQ(network.inputs(), 2 + 3 * 4);
  EXPECT_EQ(network.outputs(), 5 * (3 + 1));
}

TEST(SetNetwork, BeginsWithHesBoundOfEachLayer) {
  const SetNetwork network({2, 3, 4, 5, {60, 70}, {80}, {90}});
  const Vector parameters = network.InitialParameters(1);
  EXPECT_EQ(parameters, network.InitialParameters(1));
  EXPECT_NE(parameters, network.InitialParameters(2));
  const float largest = parameters.head(6 * 60).cwiseAbs().maxCoeff();  // the encoder's first weights
  EXPECT_LE(largest, 1.0f);                                             // sqrt(6 / 6)
  EXPECT_GT(largest, 0.98f);
  EXPECT_EQ(parameters.segment(6 * 60, 60), Vector::Zero(60));
}

}  // namespace
}  // namespace fresco
