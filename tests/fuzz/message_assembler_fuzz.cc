// Datagrams of several senders, put together to LCM's messages. The input is a sequence of datagrams, each
// behind a byte that names the sender and the time that passes, and its length as two big-endian bytes. What
// comes out stood in datagrams of one sender, without a hole, and memory has its limit.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "bus/message_assembler.h"
#include "core/bytes.h"
#include "core/error.h"
#include "tests/fuzz/fuzz_input.h"

namespace fresco {
namespace {

constexpr size_t kPrefixBytes = 3;
constexpr size_t kMemoryBytes = 4000;  // for a few messages

struct Arrived {
  uint64_t sender;
  std::string datagram;
};

template <class Unsigned>
Unsigned Number(const std::string& datagram, size_t at) {
  return ReadBigEndian<Unsigned>(reinterpret_cast<const std::byte*>(datagram.data()) + at);
}

/// What the datagram has to have at its beginning to be fragment `number` of the message of `last`.
bool IsOfTheSameMessage(const Arrived& arrived, const Arrived& last, uint16_t number) {
  return arrived.sender == last.sender && arrived.datagram.size() >= kFragmentHeaderBytes &&
         arrived.datagram.substr(0, 12) == last.datagram.substr(0, 12) &&
         Number<uint16_t>(arrived.datagram, 16) == number &&
         arrived.datagram.substr(18, 2) == last.datagram.substr(18, 2);
}

/// Whether data of fragments that have arrived, in the order of their numbers, are the message.
bool StoodInFragments(const AssembledMessage& message, const std::vector<Arrived>& all) {
  const std::string content(reinterpret_cast<const char*>(message.content.data()), message.content.size());
  std::set<size_t> ends = {0};
  const auto count = Number<uint16_t>(all.back().datagram, 18);
  for (uint16_t number = 0; number < count; ++number) {
    const std::string name = number == 0 ? message.channel + '\0' : "";
    std::set<size_t> next_ends;
    for (const Arrived& arrived : all) {
      if (IsOfTheSameMessage(arrived, all.back(), number)) {
        const std::string rest = arrived.datagram.substr(kFragmentHeaderBytes);
        const size_t offset = Number<uint32_t>(arrived.datagram, 12);
        const std::string data = rest.substr(std::min(name.size(), rest.size()));
        if (rest.starts_with(name) && ends.contains(offset) && content.substr(offset, data.size()) == data) {
          next_ends.insert(offset + data.size());
        }
      }
    }
    ends = next_ends;
  }
  return ends.contains(content.size()) && content.size() == Number<uint32_t>(all.back().datagram, 8);
}

void CheckMessage(const AssembledMessage& message, const std::vector<Arrived>& all) {
  FRESCO_CHECK(!message.channel.empty() && message.channel.size() <= kMaximumLcmChannelBytes);
  FRESCO_CHECK(message.channel.find('\0') == std::string::npos);
  const std::string& datagram = all.back().datagram;
  if (datagram.starts_with("LC02")) {
    const std::string content(reinterpret_cast<const char*>(message.content.data()), message.content.size());
    FRESCO_CHECK(datagram.substr(kWholeMessageHeaderBytes) == message.channel + '\0' + content);
  } else {
    FRESCO_CHECK(datagram.starts_with("LC03") && StoodInFragments(message, all));
  }
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace fresco;
  MessageAssembler assembler(kMemoryBytes);
  std::vector<Arrived> all;
  int64_t utime = 0;
  for (std::string_view input = TextOf(data, size); input.size() >= kPrefixBytes;) {
    const size_t wanted = data[1] * size_t{256} + data[2];
    const uint8_t first = data[0];
    const std::string_view datagram = input.substr(kPrefixBytes, wanted);
    data += kPrefixBytes + datagram.size();
    input.remove_prefix(kPrefixBytes + datagram.size());
    utime += (first >> 4) * (MessageAssembler::kPatienceUs / 8);
    all.push_back({first % uint64_t{4}, std::string(datagram)});
    const std::vector<char> exact(datagram.begin(), datagram.end());
    if (const auto message = assembler.Add(std::as_bytes(std::span(exact)), all.back().sender, utime)) {
      CheckMessage(*message, all);
    }
    FRESCO_CHECK(assembler.memory_bytes() <= kMemoryBytes + 6 * size);  // what one message alone can take
  }
  return 0;
}
