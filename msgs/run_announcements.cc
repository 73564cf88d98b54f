#include "msgs/run_announcements.h"

#include <algorithm>

namespace fresco {

std::optional<std::string> RunAnnouncements::Add(const run_t& message) {
  if (message.part_count < 1 || message.part_count > kMaximumParts || message.part_index < 0 ||
      message.part_index >= message.part_count) {
    return std::nullopt;
  }
  if (IdentityOf(message) != identity_ || parts_.size() != static_cast<size_t>(message.part_count)) {
    identity_ = IdentityOf(message);
    parts_.assign(static_cast<size_t>(message.part_count), std::nullopt);
  }
  parts_[static_cast<size_t>(message.part_index)].emplace(message.part.begin(), message.part.end());
  std::string text;
  for (const auto& part : parts_) {
    if (!part) {
      return std::nullopt;
    }
    text += *part;
  }
  return text;
}

int RunAnnouncements::parts() const {
  return static_cast<int>(
      std::count_if(parts_.begin(), parts_.end(), [](const auto& part) { return part.has_value(); }));
}

}  // namespace fresco
