// Chooses the implementation of the networks' arithmetic: at first the fastest that this processor has. All
// give the same bits.
#pragma once

#include <span>
#include <string>

#include "nn/arithmetic_kernels.h"

namespace fresco {

/// The implementation in use. Any thread may call it.
const Arithmetic& CurrentArithmetic();

/// Those that this processor can run, the fastest first.
std::span<const Arithmetic* const> AvailableArithmetics();

/// Their names, as a list for texts.
std::string ArithmeticNames();

/// From now on uses the implementation with this name. Throws UsageError that lists the names if this
/// processor can run none. No other thread may compute meanwhile.
void UseArithmetic(const std::string& name);

}  // namespace fresco
