// What a world computes from a state, written down as formulas: so that a policy can leave Fresco with
// everything that it needs (exports/). A formula's value is a list of numbers, in single or double precision.
// Every operation is rounded by itself, as IEEE 754 defines it, so a formula can repeat a function of C++ to
// the bit. Single-threaded.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace fresco {

enum class Operation : uint8_t {
  kState,       ///< entries of the state from `first` on
  kConstant,    ///< `numbers`
  kAdd,         ///< of two operands, entry by entry; so are the next
  kSubtract,    //
  kMultiply,    //
  kDivide,      //
  kLargest,     //
  kAtMost,      ///< 1 if the first operand's entry is at most the second one's, otherwise 0
  kSquareRoot,  ///< of each entry; so are the next
  kFloor,       //
  kRound,       ///< to the nearest whole number, from halfway to the even one
  kNegate,      //
  kToDouble,    //
  kToSingle,    ///< rounds
  kSum,         ///< of all entries, one after the other
  kChoose,      ///< for each entry of the first operand that is not 0 the second one's, otherwise the third's
  kPart,        ///< entries from `first` on
  kRow,         ///< of the table `numbers`, row after row; the operand is the row's number
  kJoin,        ///< all entries of the first operand, then those of the second one, ...
};

enum class Precision : uint8_t { kSingle, kDouble };

/// The operands of kAdd to kAtMost and of kChoose have as many entries as the result, or one, which is then
/// used for every entry.
struct Formula {
  Operation operation = Operation::kConstant;
  Precision precision = Precision::kSingle;  ///< of the value
  int size = 0;                              ///< number of entries
  std::vector<int> operands;                 ///< earlier formulas
  int first = 0;                             ///< for kState and kPart
  std::vector<double> numbers;               ///< for kConstant and kRow; exact in the precision
};

class Formulas;

/// A formula in its list, to be combined with operators and the functions below. Both operands must have the
/// same precision. They CHECK sizes and precisions.
struct Term {
  Formulas* list = nullptr;
  int index = 0;
};

/// Formulas, each after those that it uses.
class Formulas {
 public:
  Term State(int first, int count);
  Term Single(std::vector<double> numbers);  ///< rounds them to single precision
  Term Double(std::vector<double> numbers);
  /// Row `number`, which has one entry and is a whole number, of a table in single precision.
  Term Row(std::vector<double> table, int row_size, Term number);
  Term Join(const std::vector<Term>& parts);
  Term Add(Formula formula);

  const std::vector<Formula>& formulas() const { return formulas_; }
  const Formula& operator[](int index) const { return formulas_[static_cast<size_t>(index)]; }

 private:
  std::vector<Formula> formulas_;
};

Term operator+(Term a, Term b);
Term operator-(Term a, Term b);
Term operator*(Term a, Term b);
Term operator/(Term a, Term b);
Term operator-(Term a);
// A number is rounded to the other operand's precision.
Term operator+(Term a, double b);
Term operator-(Term a, double b);
Term operator*(Term a, double b);
Term operator/(Term a, double b);
Term operator+(double a, Term b);
Term operator-(double a, Term b);
Term operator*(double a, Term b);
Term Largest(Term a, double b);
Term AtMost(Term a, double b);
Term AtMost(double a, Term b);
Term Choose(Term condition, double yes, Term no);
Term Largest(Term a, Term b);
Term AtMost(Term a, Term b);
Term SquareRoot(Term a);
Term Floor(Term a);
Term RoundToWhole(Term a);
Term ToDouble(Term a);
Term ToSingle(Term a);
Term Sum(Term a);
Term Choose(Term condition, Term yes, Term no);
Term Part(Term a, int first, int count);

/// What World::Observe and Environment::WriteMask compute, of states in which an episode has not ended.
struct StateFormulas {
  Term observation;          ///< in single precision
  std::optional<Term> mask;  ///< 1 for what is allowed, otherwise 0; none if only the environment knows it
};

}  // namespace fresco
