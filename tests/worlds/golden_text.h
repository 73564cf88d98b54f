// Texts that tests expect as they are in tests/worlds/golden. After a change that is meant, write them anew
// and read what changed:
//   FRESCO_WRITE_GOLDENS=1 build/release/bin/worlds_test --gtest_filter='*Golden*'
#pragma once

#include <string>

namespace fresco {

/// Fails at the first line in which `text` differs from tests/worlds/golden/NAME.txt. Writes the file instead
/// if FRESCO_WRITE_GOLDENS is set.
void ExpectGoldenText(const std::string& name, const std::string& text);

}  // namespace fresco
