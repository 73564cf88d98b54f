// How --help looks: the placeholder of each value, wrapped descriptions with the default and what an option
// can't be combined with. Used by the main thread.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace fresco {

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* command) const override;
};

/// Text for the end of a command's help: one example a line, each what one types.
std::string HelpExamples(const std::vector<std::string>& examples);

}  // namespace fresco
