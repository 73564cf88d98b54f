#include "logs/log_messages.h"

#include "bus/authenticated_bus.h"

namespace fresco {

std::optional<LogMessage> LogMessages::Next() {
  while (const auto event = logs_.Next()) {
    const auto content = source_.key ? AuthenticContent(*source_.key, event->channel, event->message)
                                     : std::optional(WithoutAuthentication(event->message));
    if (content) {
      return LogMessage{event->channel, *content};
    }
    ++refused_;
  }
  return std::nullopt;
}

}  // namespace fresco
