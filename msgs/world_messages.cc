#include "msgs/world_messages.h"

#include <algorithm>
#include <sstream>

namespace fresco {
namespace {

std::string LineOf(const Quantity& quantity) {
  return quantity.unit.empty() ? quantity.name : quantity.name + " [" + quantity.unit + "]";
}

Quantity QuantityOf(const std::string& line) {
  const size_t bracket = line.rfind(" [");
  return bracket == std::string::npos || !line.ends_with(']')
             ? Quantity{line, ""}
             : Quantity{line.substr(0, bracket), line.substr(bracket + 2, line.size() - bracket - 3)};
}

std::vector<std::string> LinesOf(const WorldDescription& description) {
  std::vector<std::string> lines;
  std::transform(description.state.begin(), description.state.end(), std::back_inserter(lines), LineOf);
  lines.insert(lines.end(), description.actions.begin(), description.actions.end());
  std::transform(description.figures.begin(), description.figures.end(), std::back_inserter(lines), LineOf);
  return lines;
}

/// The number of entries of all messages; 0 if the numbers are absurd.
size_t TotalEntries(const world_t& message) {
  constexpr int kMaximumFigures = 100;
  const bool allowed = message.state_size >= 1 && message.state_size <= kMaximumStateSize &&
                       message.action_count >= 1 && message.action_count <= kMaximumActions &&
                       message.figure_count >= 1 && message.figure_count <= kMaximumFigures;
  return allowed ? static_cast<size_t>(message.state_size + message.action_count + message.figure_count) : 0;
}

bool AreOfOneWorld(const world_t& a, const world_t& b) {
  return IdentityOf(a) == IdentityOf(b) && a.world == b.world && a.state_size == b.state_size &&
         a.action_count == b.action_count && a.figure_count == b.figure_count;
}

}  // namespace

std::vector<world_t> WorldMessages(const World& world) {
  const WorldDescription& description = world.description();
  world_t message{};
  message.world = description.name;
  message.success = description.success;
  message.state_size = world.state_size();
  message.action_count = world.actions();
  message.figure_count = static_cast<int32_t>(description.figures.size());
  message.longest_episode = world.longest_episode();
  message.less_is_better = description.less_is_better ? 1 : 0;
  std::vector<world_t> messages;
  for (const std::string& line : LinesOf(description)) {
    if (message.entries.size() + line.size() + 1 > kMaximumEntriesBytes) {
      messages.push_back(message);
      message.first_entry += message.entry_count;
      message.entry_count = 0;
      message.entries.clear();
    }
    message.entries += line + '\n';
    ++message.entry_count;
  }
  messages.push_back(message);
  return messages;
}

void WorldNamesReader::Add(const world_t& message) {
  const size_t total = TotalEntries(message);
  if (total == 0 || message.first_entry < 0) {
    return;
  }
  if (entries_.empty() || !AreOfOneWorld(first_, message)) {
    first_ = message;
    entries_.assign(total, std::nullopt);
    missing_ = total;
    names_.reset();
  }
  std::istringstream lines(message.entries);
  size_t index = static_cast<size_t>(message.first_entry);
  for (std::string line; index < total && std::getline(lines, line); ++index) {
    missing_ -= entries_[index] ? 0 : 1;
    // Only quantities have units.
    const bool is_action = index >= static_cast<size_t>(message.state_size) &&
                           index < static_cast<size_t>(message.state_size + message.action_count);
    entries_[index] = is_action ? Quantity{line, ""} : QuantityOf(line);
  }
  if (missing_ > 0 || names_) {
    return;
  }
  names_.emplace();
  names_->world = message.world;
  names_->success = message.success;
  names_->less_is_better = message.less_is_better != 0;
  for (size_t i = 0; i < total; ++i) {
    if (i < static_cast<size_t>(message.state_size)) {
      names_->state.push_back(*entries_[i]);
    } else if (i < static_cast<size_t>(message.state_size + message.action_count)) {
      names_->actions.push_back(entries_[i]->name);
    } else {
      names_->figures.push_back(*entries_[i]);
    }
  }
}

}  // namespace fresco
