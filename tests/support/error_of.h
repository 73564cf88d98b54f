// The text of the Error that something throws, for tests of what it says.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"

namespace fresco {

/// The error's text; a test failure and "" if nothing is thrown or the error is of another kind.
template <class Callable>
std::string ErrorOf(Callable&& callable, ErrorKind kind = ErrorKind::kUsage) {
  try {
    callable();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "expected an error";
  return "";
}

}  // namespace fresco
