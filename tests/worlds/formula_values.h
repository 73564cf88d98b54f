// Computes formulas (worlds/formulas.h) the slow way, for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "worlds/formulas.h"

namespace fresco {

/// The values of all formulas for a state.
inline std::vector<std::vector<double>> ValuesOf(const Formulas& formulas, std::span<const float> state) {
  std::vector<std::vector<double>> values;
  for (const Formula& formula : formulas.formulas()) {
    std::vector<double> result(static_cast<size_t>(formula.size));
    const auto operand = [&](size_t number, size_t entry) {
      const std::vector<double>& from = values[static_cast<size_t>(formula.operands[number])];
      return from[from.size() == 1 ? 0 : entry];
    };
    const auto first = static_cast<size_t>(formula.first);
    if (formula.operation == Operation::kJoin) {
      result.clear();
      for (const int part : formula.operands) {
        const std::vector<double>& from = values[static_cast<size_t>(part)];
        result.insert(result.end(), from.begin(), from.end());
      }
    }
    if (formula.operation == Operation::kSum) {
      const std::vector<double>& from = values[static_cast<size_t>(formula.operands[0])];
      for (const double entry : from) {
        result[0] = formula.precision == Precision::kSingle ? static_cast<float>(result[0] + entry)
                                                            : result[0] + entry;
      }
    }
    for (size_t i = 0; i < result.size(); ++i) {
      double& value = result[i];
      switch (formula.operation) {
        case Operation::kState:
          value = state[first + i];
          break;
        case Operation::kConstant:
          value = formula.numbers[i];
          break;
        case Operation::kAdd:
          value = operand(0, i) + operand(1, i);
          break;
        case Operation::kSubtract:
          value = operand(0, i) - operand(1, i);
          break;
        case Operation::kMultiply:
          value = operand(0, i) * operand(1, i);
          break;
        case Operation::kDivide:
          value = operand(0, i) / operand(1, i);
          break;
        case Operation::kLargest:
          value = std::max(operand(0, i), operand(1, i));
          break;
        case Operation::kAtMost:
          value = operand(0, i) <= operand(1, i) ? 1 : 0;
          break;
        case Operation::kSquareRoot:
          value = std::sqrt(operand(0, i));
          break;
        case Operation::kFloor:
          value = std::floor(operand(0, i));
          break;
        case Operation::kRound:
          value = std::nearbyint(operand(0, i));
          break;
        case Operation::kNegate:
          value = -operand(0, i);
          break;
        case Operation::kToDouble:
        case Operation::kToSingle:
          value = operand(0, i);
          break;
        case Operation::kChoose:
          value = operand(0, i) != 0 ? operand(1, i) : operand(2, i);
          break;
        case Operation::kPart:
          value = values[static_cast<size_t>(formula.operands[0])][first + i];
          break;
        case Operation::kRow:
          value = formula.numbers[static_cast<size_t>(operand(0, 0)) * result.size() + i];
          break;
        case Operation::kJoin:
        case Operation::kSum:
          break;
      }
      if (formula.precision == Precision::kSingle) {
        // A double result of one operation on floats, rounded to a float, is what an operation on floats
        // gives.
        value = static_cast<float>(value);
      }
    }
    values.push_back(std::move(result));
  }
  return values;
}

}  // namespace fresco
