#include "msgs/wire.h"

#include "core/check.h"

namespace fresco {
namespace {

constexpr size_t kFingerprintBytes = 8;
constexpr size_t kIdentityBytes = 3 * sizeof(int64_t);

int32_t BigEndianInt32(std::span<const std::byte> bytes) {
  uint32_t value = 0;
  for (size_t i = 0; i < sizeof value; ++i) {
    value = (value << 8) | static_cast<uint32_t>(bytes[i]);
  }
  return static_cast<int32_t>(value);
}

}  // namespace

bool CountsAreAllowed(std::span<const std::byte> message, std::initializer_list<int32_t> maxima) {
  size_t offset = kFingerprintBytes + kIdentityBytes;
  if (message.size() > kMaximumMessageBytes || message.size() < offset + maxima.size() * sizeof(int32_t)) {
    return false;
  }
  for (const int32_t maximum : maxima) {
    const int32_t count = BigEndianInt32(message.subspan(offset, sizeof(int32_t)));
    if (count < 0 || count > maximum) {
      return false;
    }
    offset += sizeof(int32_t);
  }
  return true;
}

void CheckEncoded(int encoded, size_t size) {
  FRESCO_CHECK(encoded == static_cast<int>(size));
  FRESCO_CHECK(size <= kMaximumEncodedBytes);
}

}  // namespace fresco
