#include "tests/worlds/golden_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <vector>

#include "core/files.h"

namespace fresco {
namespace {

std::vector<std::string> GoldenLines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

}  // namespace

void ExpectGoldenText(const std::string& name, const std::string& text) {
  const std::string path = FRESCO_SOURCE_DIR "/tests/worlds/golden/" + name + ".txt";
  if (std::getenv("FRESCO_WRITE_GOLDENS") != nullptr) {
    std::ofstream(path) << text;
    return;
  }
  std::vector<std::string> expected = GoldenLines(ReadFile(path));
  std::vector<std::string> found = GoldenLines(text);
  const size_t lines = std::max(expected.size(), found.size());
  expected.resize(lines, "(the end)");
  found.resize(lines, "(the end)");
  for (size_t i = 0; i < lines; ++i) {
    if (expected[i] != found[i]) {
      FAIL() << path << ", line " << i + 1 << ":\n  expected: " << expected[i] << "\n  found:    " << found[i]
             << "\nIf this is meant: FRESCO_WRITE_GOLDENS=1 build/release/bin/worlds_test "
                "--gtest_filter='*Golden*'";
    }
  }
}

}  // namespace fresco
