// The text of the UsageError that something throws, for tests of what it says.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"

namespace fresco {

/// The error's text; a failure and "" where nothing is thrown or the error is of another kind.
template <class Callable>
std::string UsageErrorOf(Callable&& callable) {
  try {
    callable();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "expected a UsageError";
  return "";
}

}  // namespace fresco
