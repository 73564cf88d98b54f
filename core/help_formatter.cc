#include "core/help_formatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <vector>

namespace fresco {
namespace {

constexpr size_t kLineColumns = 100;
constexpr size_t kDescriptionColumn = 28;

/// Breaks the text between words. Every line but the first begins at `column`, where the first one is, too.
std::string Wrapped(const std::string& text, size_t column) {
  std::string lines;
  size_t line_end = column;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.empty() && line_end + 1 + word.size() > kLineColumns) {
      lines += "\n" + std::string(column, ' ');
      line_end = column;
    } else if (!lines.empty()) {
      lines += ' ';
      ++line_end;
    }
    lines += word;
    line_end += word.size();
  }
  return lines;
}

/// A row of a list: "  name   description".
std::string Row(const std::string& name, const std::string& description) {
  std::string row = "  " + name;
  const bool fits = row.size() + 2 <= kDescriptionColumn;
  row +=
      fits ? std::string(kDescriptionColumn - row.size(), ' ') : "\n" + std::string(kDescriptionColumn, ' ');
  return row + Wrapped(description, kDescriptionColumn) + "\n";
}

/// What stands for the option's value: "{text,json}", "N", "URL". CLI11 describes a type as "TYPE:CHECK".
std::string Placeholder(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const size_t colon = type.find(':');
  if (colon != std::string::npos && type.find('{') == colon + 1) {
    return type.substr(colon + 1);
  }
  const std::string name = type.substr(0, colon);
  return name == "INT" || name == "UINT" || name == "FLOAT" ? "N" : name;
}

std::string Names(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  names.reserve(options.size());
  for (const CLI::Option* option : options) {
    names.push_back(option->get_name());
  }
  std::sort(names.begin(), names.end());
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string Description(const CLI::Option& option) {
  std::string text = option.get_description();
  if (!option.get_needs().empty()) {
    text += "; only with " + Names(option.get_needs());
  }
  if (!option.get_excludes().empty()) {
    text += "; not with " + Names(option.get_excludes());
  }
  if (!option.get_default_str().empty()) {
    text += "; default: " + option.get_default_str();
  }
  if (option.get_required() && !option.get_positional()) {
    text += " (required)";
  }
  return text;
}

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  std::string name = option->get_name(is_positional, true);
  if (!is_positional && option->get_type_size() != 0) {
    name += " " + Placeholder(*option);
  }
  return Row(name, Description(*option));
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return Row(command->get_name(), command->get_description());
}

std::string HelpFormatter::make_description(const CLI::App* command) const {
  return Wrapped(command->get_description(), 0) + "\n";
}

std::string HelpExamples(const std::vector<std::string>& examples) {
  return fmt::format("Examples:\n  {}", fmt::join(examples, "\n  "));
}

}  // namespace fresco
