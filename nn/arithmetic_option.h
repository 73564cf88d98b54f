// The option --arithmetic, the same in every program that computes networks.
#pragma once

namespace CLI {
class App;
}

namespace fresco {

/// Adds --arithmetic, with which parsing calls UseArithmetic (nn/arithmetic.h).
void AddArithmeticOption(CLI::App& app);

}  // namespace fresco
