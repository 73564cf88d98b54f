#include "core/command_line.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "core/help_formatter.h"
#include "core/installation.h"
#include "core/signals.h"

namespace fresco {
namespace {

/// An argument that is no option and that the command does not expect, and the command.
struct UnexpectedArgument {
  const CLI::App* command;
  std::string text;
};

std::optional<UnexpectedArgument> FirstUnexpected(const CLI::App& command) {
  if (const std::vector<std::string> texts = command.remaining(); !texts.empty()) {
    return UnexpectedArgument{&command, texts.front()};
  }
  const std::vector<CLI::App*> chosen = command.get_subcommands();
  return chosen.empty() ? std::nullopt : FirstUnexpected(*chosen.front());
}

const CLI::App& InnermostCommand(const CLI::App& command) {
  const std::vector<CLI::App*> chosen = command.get_subcommands();
  return chosen.empty() ? command : InnermostCommand(*chosen.front());
}

/// "fresco log record".
std::string FullName(const CLI::App& command) {
  return (command.get_parent() == nullptr ? "" : FullName(*command.get_parent()) + " ") + command.get_name();
}

std::vector<const CLI::App*> CommandsOf(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

/// "train, evaluate, log".
std::string CommandList(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* below : CommandsOf(command)) {
    names.push_back(below->get_name());
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Every command below this one, as it would be typed: "log", "log record".
std::vector<std::string> CommandNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* below : CommandsOf(command)) {
    names.push_back(below->get_name());
    for (const std::string& name : CommandNames(*below)) {
      names.push_back(below->get_name() + " " + name);
    }
  }
  return names;
}

std::vector<std::string> OptionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      names.push_back("--" + name);
    }
  }
  return names;
}

std::string Describe(const UnexpectedArgument& argument) {
  if (argument.text.starts_with('-')) {
    const std::string name = argument.text.substr(0, argument.text.find('='));
    return fmt::format("there is no option {}{}", name, DidYouMean(name, OptionNames(*argument.command)));
  }
  if (CommandsOf(*argument.command).empty()) {
    return fmt::format("expected options only, found \"{}\"", argument.text);
  }
  return fmt::format("there is no command \"{}\"; expected {}{}", argument.text,
                     CommandList(*argument.command),
                     DidYouMean(argument.text, CommandNames(*argument.command)));
}

/// What CLI11 says is wrong, or a word more if a command is missing.
std::string Describe(const CLI::ParseError& error, const CLI::App& command) {
  const bool lacks_command =
      dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && !CommandsOf(command).empty();
  return lacks_command ? "expected a command: " + CommandList(command) : error.what();
}

[[noreturn]] void ThrowWrongUse(const CLI::App& command, const std::string& problem) {
  const std::string name = FullName(command);
  throw UsageError(fmt::format("{}: {}\nsee {} --help", name, problem, name));
}

}  // namespace

Program::Program(const std::string& name, const std::string& description, LogStyle style, const Build& build)
    : command_line_(description, name), style_(style) {
  command_line_.formatter(std::make_shared<HelpFormatter>());
  command_line_.get_help_ptr()->description("Print this help");
  command_line_.set_version_flag(
      "--version", fmt::format("{} {}, commit {}{}", name, kSoftwareVersion, build.commit,
                               build.arithmetic.empty() ? "" : ", arithmetic " + build.arithmetic));
  command_line_.get_version_ptr()->description("Print version, commit and the arithmetic of networks");
}

int Program::Run(int argc, const char* const* argv, const std::function<int()>& run) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt(command_line_.get_name()));
  StopSignal::Install();
  if (style_ == LogStyle::kTimed) {
    spdlog::set_pattern("%H:%M:%S %n[%P] %l: %v");
    StateSignal::Install();
  } else {
    spdlog::set_pattern("%n: %l: %v");
  }
  int status = static_cast<int>(ErrorKind::kFailure);
  try {
    return ParseCommandLine(command_line_, argc, argv) ? run() : 0;
  } catch (const Error& error) {
    status = error.exit_status();
    spdlog::error("{}", error.what());
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
  }
  return status;
}

bool ParseCommandLine(CLI::App& app, int argc, const char* const* argv) {
  try {
    app.parse(argc, argv);
    return true;
  } catch (const CLI::Success& asked) {
    app.exit(asked);
    return false;
  } catch (const CLI::ValidationError& error) {
    ThrowWrongUse(InnermostCommand(app), error.what());
  } catch (const CLI::ParseError& error) {
    // A misspelt name is also a missing one ("--policy is required"): what was given tells more.
    if (const auto unexpected = FirstUnexpected(app)) {
      ThrowWrongUse(*unexpected->command, Describe(*unexpected));
    }
    ThrowWrongUse(InnermostCommand(app), Describe(error, InnermostCommand(app)));
  }
}

CLI::Validator OneOf(const std::vector<std::string>& names) {
  const auto check = [names](std::string& given) {
    const bool is_one = std::find(names.begin(), names.end(), given) != names.end();
    return is_one ? std::string()
                  : fmt::format("expected {}, found \"{}\"{}", fmt::join(names, " or "), given,
                                DidYouMean(given, names));
  };
  return {check, fmt::format("{{{}}}", fmt::join(names, ",")), ""};
}

}  // namespace fresco
