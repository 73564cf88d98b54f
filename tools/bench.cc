#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/installation.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

std::string BenchProgram() {
  try {
    return SiblingProgram("fresco-bench").string();
  } catch (const Error& error) {
    throw UsageError(fmt::format(
        "bench: {}; in the source tree, tools/fresco bench installs the libraries that it compares with and "
        "builds it",
        error.what()));
  }
}

/// Replaces this process by fresco-bench, which has libraries that `fresco` does not need.
int BecomeBench(const std::vector<std::string>& given) {
  const std::string program = BenchProgram();
  std::vector<char*> arguments = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : given) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  throw Failure(fmt::format("bench: {} can't be run: {}", program, std::strerror(errno)));
}

}  // namespace

void AddBench(CLI::App& app, Command& command) {
  CLI::App* bench = app.add_subcommand("bench", "Measure how fast it is, beside roofs and peers");
  bench->set_help_flag();  // fresco-bench has the options and their help
  bench->prefix_command();
  bench->callback(
      [bench, &command] { command = [arguments = bench->remaining()] { return BecomeBench(arguments); }; });
}

}  // namespace fresco
