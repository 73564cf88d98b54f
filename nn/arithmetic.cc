#include "nn/arithmetic.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"

namespace fresco {
namespace {

std::vector<const Arithmetic*> FindAvailable() {
  std::vector<const Arithmetic*> available;
#if defined(__x86_64__)
  __builtin_cpu_init();
  const auto has_v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (has_v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    available.push_back(&kArithmeticX86V4);
  }
  if (has_v3) {
    available.push_back(&kArithmeticX86V3);
  }
#elif defined(__aarch64__)
  available.push_back(&kArithmeticAarch64);
#endif
  available.push_back(&kArithmeticPortable);
  return available;
}

const Arithmetic*& Current() {
  static const Arithmetic* current = AvailableArithmetics().front();
  return current;
}

}  // namespace

const Arithmetic& CurrentArithmetic() {
  return *Current();
}

std::span<const Arithmetic* const> AvailableArithmetics() {
  static const std::vector<const Arithmetic*> available = FindAvailable();
  return available;
}

std::string ArithmeticNames() {
  std::string names;
  for (const Arithmetic* arithmetic : AvailableArithmetics()) {
    names += (names.empty() ? "" : ", ") + std::string(arithmetic->name);
  }
  return names;
}

void UseArithmetic(const std::string& name) {
  for (const Arithmetic* arithmetic : AvailableArithmetics()) {
    if (arithmetic->name == name) {
      Current() = arithmetic;
      return;
    }
  }
  throw UsageError("--arithmetic: expected one that this build has for this processor (" + ArithmeticNames() +
                   "), found \"" + name + "\"");
}

}  // namespace fresco
