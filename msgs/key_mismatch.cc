#include "msgs/key_mismatch.h"

#include <fmt/format.h>

#include "msgs/wire.h"

namespace fresco {

void KeyMismatch::Note(std::span<const std::byte> undecodable) {
  authenticated_ += CarriesAuthentication(undecodable) ? 1 : 0;
}

std::string KeyMismatch::Reason() const {
  if (const int64_t refused = bus_->refused_messages(); refused > 0) {
    return fmt::format(
        "{} messages dropped: made with another key than that of --key-file here, or with none", refused);
  }
  if (authenticated_ > 0) {
    return fmt::format("{} messages dropped: made with a key, and no --key-file is given here",
                       authenticated_);
  }
  return "";
}

std::string KeyMismatch::News() {
  std::string news = told_ ? "" : Reason();
  told_ = told_ || !news.empty();
  return news;
}

}  // namespace fresco
