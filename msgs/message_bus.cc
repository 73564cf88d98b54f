#include "msgs/message_bus.h"

#include <fmt/format.h>

namespace fresco {

void MessageBus::NoteMalformed(std::span<const std::byte> bytes) {
  ++malformed_;
  with_unknown_key_ += CarriesAuthentication(bytes) ? 1 : 0;
}

std::string MessageBus::KeyMismatch() const {
  if (const int64_t refused = unauthenticated_messages(); refused > 0) {
    return fmt::format(
        "{} messages dropped: made with another key than that of --key-file here, or with none", refused);
  }
  if (with_unknown_key_ > 0) {
    return fmt::format("{} messages dropped: made with a key, and no --key-file is given here",
                       with_unknown_key_.load());
  }
  return "";
}

std::string MessageBus::KeyMismatchNews() {
  std::string news = told_ ? "" : KeyMismatch();
  told_ = told_ || !news.empty();
  return news;
}

}  // namespace fresco
