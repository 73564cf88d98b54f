#include "nn/arithmetic_option.h"

#include <CLI/CLI.hpp>
#include <string>

#include "nn/arithmetic.h"

namespace fresco {

void AddArithmeticOption(CLI::App& app) {
  app.add_option_function<std::string>("--arithmetic", UseArithmetic,
                                       "How networks are computed, the fastest by default: " +
                                           ArithmeticNames() + "; all give the same bits")
      ->type_name("NAME");
}

}  // namespace fresco
