// Notices where messages do not get through because sender and receiver have not the same key, so that
// nobody waits without knowing why. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "bus/bus.h"

namespace fresco {

class KeyMismatch {
 public:
  /// `bus` must outlive the object.
  explicit KeyMismatch(const Bus& bus) : bus_(&bus) {}

  /// Notes a message that did not decode.
  void Note(std::span<const std::byte> undecodable);

  /// How many messages were dropped so far, and why; empty where none was for want of the right key.
  std::string Reason() const;

  /// Reason's text when it is there for the first time; empty at every other call.
  std::string News();

 private:
  const Bus* bus_;
  int64_t authenticated_ = 0;  // messages that this program can't read, having no key
  bool told_ = false;
};

}  // namespace fresco
