#include "msgs/wire.h"

#include <algorithm>
#include <iterator>

#include "bus/authenticated_bus.h"
#include "core/bytes.h"
#include "core/error.h"

namespace fresco {
namespace {

constexpr size_t kFirstCountOffset = Description<orders_t>::order_count_offset;  // the same in every message

static_assert(kTrailerBytes + kAuthenticationTagBytes <= kReservedTrailerBytes);

int32_t ReadInt32(std::span<const std::byte> bytes) {
  return static_cast<int32_t>(ReadBigEndian<uint32_t>(bytes.data()));
}

}  // namespace

std::span<const std::byte> WithoutTrailer(std::span<const std::byte> bytes) {
  if (bytes.size() < kTrailerBytes || bytes.size() > kMaximumEncodedBytes + kTrailerBytes) {
    return {};
  }
  const auto encoding = bytes.first(bytes.size() - kTrailerBytes);
  const bool holds = Crc32c(encoding) == ReadBigEndian<uint32_t>(bytes.last(kTrailerBytes).data());
  return holds ? encoding : std::span<const std::byte>{};
}

bool CarriesAuthentication(std::span<const std::byte> bytes) {
  return bytes.size() > kAuthenticationTagBytes + kTrailerBytes &&
         !WithoutTrailer(bytes.first(bytes.size() - kAuthenticationTagBytes)).empty();
}

void AppendTrailer(int encoded, std::vector<std::byte>& bytes) {
  FRESCO_CHECK(encoded == static_cast<int>(bytes.size()));
  FRESCO_CHECK(bytes.size() <= kMaximumEncodedBytes);
  const uint32_t crc = Crc32c(bytes);
  for (const int shift : {24, 16, 8, 0}) {
    bytes.push_back(static_cast<std::byte>(crc >> shift));
  }
}

bool CountsAreAllowed(std::span<const std::byte> encoding, std::span<const int32_t> maxima) {
  size_t offset = kFirstCountOffset;
  if (encoding.size() < offset + maxima.size() * sizeof(int32_t)) {
    return false;
  }
  for (const int32_t maximum : maxima) {
    const int32_t count = ReadInt32(encoding.subspan(offset, sizeof(int32_t)));
    if (count < 0 || count > maximum) {
      return false;
    }
    offset += sizeof(int32_t);
  }
  return true;
}

bool TextsAreAllowed(std::span<const std::byte> encoding, size_t offset, int count) {
  for (int text = 0; text < count; ++text) {
    const size_t begin = offset + sizeof(int32_t);
    if (encoding.size() <= begin) {
      return false;
    }
    const int32_t length = ReadInt32(encoding.subspan(offset, sizeof(int32_t)));
    if (length < 1 || static_cast<size_t>(length) > encoding.size() - begin) {
      return false;
    }
    const auto characters = encoding.subspan(begin, static_cast<size_t>(length));
    if (std::find(characters.begin(), characters.end(), std::byte{0}) != std::prev(characters.end())) {
      return false;
    }
    offset = begin + static_cast<size_t>(length);
  }
  return true;
}

}  // namespace fresco
