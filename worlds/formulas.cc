#include "worlds/formulas.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace fresco {
namespace {

const Formula& At(Term term) {
  return (*term.list)[term.index];
}

/// An operation on entries in the same places.
Term EntryByEntry(Operation operation, const std::vector<Term>& operands) {
  Formula formula{operation, At(operands.back()).precision, 1, {}, 0, {}};
  for (const Term operand : operands) {
    formula.size = std::max(formula.size, At(operand).size);
    formula.operands.push_back(operand.index);
  }
  for (const Term operand : operands) {
    FRESCO_CHECK(operand.list == operands.front().list);
    FRESCO_CHECK(At(operand).size == formula.size || At(operand).size == 1);
    const bool is_condition = operation == Operation::kChoose && operand.index == operands.front().index;
    FRESCO_CHECK(is_condition || At(operand).precision == formula.precision);
  }
  return operands.front().list->Add(std::move(formula));
}

Term OfEachEntry(Operation operation, Term a, Precision precision) {
  return a.list->Add({operation, precision, At(a).size, {a.index}, 0, {}});
}

Term NumberLike(Term term, double number) {
  return At(term).precision == Precision::kSingle ? term.list->Single({number}) : term.list->Double({number});
}

}  // namespace

Term Formulas::Add(Formula formula) {
  formulas_.push_back(std::move(formula));
  return {this, static_cast<int>(formulas_.size()) - 1};
}

Term Formulas::State(int first, int count) {
  return Add({Operation::kState, Precision::kSingle, count, {}, first, {}});
}

Term Formulas::Single(std::vector<double> numbers) {
  for (double& number : numbers) {
    number = static_cast<float>(number);
  }
  const int size = static_cast<int>(numbers.size());
  return Add({Operation::kConstant, Precision::kSingle, size, {}, 0, std::move(numbers)});
}

Term Formulas::Double(std::vector<double> numbers) {
  const int size = static_cast<int>(numbers.size());
  return Add({Operation::kConstant, Precision::kDouble, size, {}, 0, std::move(numbers)});
}

Term Formulas::Row(std::vector<double> table, int row_size, Term number) {
  FRESCO_CHECK(At(number).size == 1 && !table.empty() && table.size() % static_cast<size_t>(row_size) == 0);
  for (double& entry : table) {
    entry = static_cast<float>(entry);
  }
  return Add({Operation::kRow, Precision::kSingle, row_size, {number.index}, 0, std::move(table)});
}

Term Formulas::Join(const std::vector<Term>& parts) {
  Formula formula{Operation::kJoin, At(parts.front()).precision, 0, {}, 0, {}};
  for (const Term part : parts) {
    FRESCO_CHECK(part.list == this && At(part).precision == formula.precision);
    formula.size += At(part).size;
    formula.operands.push_back(part.index);
  }
  return Add(std::move(formula));
}

Term operator+(Term a, Term b) {
  return EntryByEntry(Operation::kAdd, {a, b});
}
Term operator-(Term a, Term b) {
  return EntryByEntry(Operation::kSubtract, {a, b});
}
Term operator*(Term a, Term b) {
  return EntryByEntry(Operation::kMultiply, {a, b});
}
Term operator/(Term a, Term b) {
  return EntryByEntry(Operation::kDivide, {a, b});
}
Term operator-(Term a) {
  return OfEachEntry(Operation::kNegate, a, At(a).precision);
}
Term operator+(Term a, double b) {
  return a + NumberLike(a, b);
}
Term operator-(Term a, double b) {
  return a - NumberLike(a, b);
}
Term operator*(Term a, double b) {
  return a * NumberLike(a, b);
}
Term operator/(Term a, double b) {
  return a / NumberLike(a, b);
}
Term operator+(double a, Term b) {
  return NumberLike(b, a) + b;
}
Term operator-(double a, Term b) {
  return NumberLike(b, a) - b;
}
Term operator*(double a, Term b) {
  return NumberLike(b, a) * b;
}
Term Largest(Term a, double b) {
  return Largest(a, NumberLike(a, b));
}
Term AtMost(Term a, double b) {
  return AtMost(a, NumberLike(a, b));
}
Term AtMost(double a, Term b) {
  return AtMost(NumberLike(b, a), b);
}
Term Choose(Term condition, double yes, Term no) {
  return Choose(condition, NumberLike(no, yes), no);
}
Term Largest(Term a, Term b) {
  return EntryByEntry(Operation::kLargest, {a, b});
}
Term AtMost(Term a, Term b) {
  return EntryByEntry(Operation::kAtMost, {a, b});
}
Term SquareRoot(Term a) {
  return OfEachEntry(Operation::kSquareRoot, a, At(a).precision);
}
Term Floor(Term a) {
  return OfEachEntry(Operation::kFloor, a, At(a).precision);
}
Term RoundToWhole(Term a) {
  return OfEachEntry(Operation::kRound, a, At(a).precision);
}
Term ToDouble(Term a) {
  return OfEachEntry(Operation::kToDouble, a, Precision::kDouble);
}
Term ToSingle(Term a) {
  return OfEachEntry(Operation::kToSingle, a, Precision::kSingle);
}
Term Sum(Term a) {
  return a.list->Add({Operation::kSum, At(a).precision, 1, {a.index}, 0, {}});
}
Term Choose(Term condition, Term yes, Term no) {
  return EntryByEntry(Operation::kChoose, {condition, yes, no});
}
Term Part(Term a, int first, int count) {
  FRESCO_CHECK(first >= 0 && count >= 1 && first + count <= At(a).size);
  return a.list->Add({Operation::kPart, At(a).precision, count, {a.index}, first, {}});
}

}  // namespace fresco
