// Assembles LCM's messages from datagrams. Anybody may have sent the datagrams, so every number in them is
// checked, and only bytes that have arrived take memory. No I/O, no clock. Only one thread may use an object;
// the thread of MulticastListener does.
//
// The format of the datagrams that LCM sends over UDP multicast. A datagram is a complete message or a
// fragment of one. All numbers are big-endian, and a zero byte ends the channel's name:
//
//   complete message: "LC02", uint32 sequence, channel, content
//   fragment:      "LC03", uint32 sequence, uint32 message_bytes, uint32 offset, uint16 number, uint16 count,
//                  in fragment 0 the channel, data
//
// `message_bytes` is the size of the complete content, and `offset` is the position of the fragment's data in
// it. Fragments with the same sender and sequence belong to the same message.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fresco {

inline constexpr uint32_t kWholeMessageMagic = 0x4C433032;  // "LC02"
inline constexpr uint32_t kFragmentMagic = 0x4C433033;      // "LC03"
inline constexpr size_t kWholeMessageHeaderBytes = 8;
inline constexpr size_t kFragmentHeaderBytes = 20;
/// The length of the longest channel name, without the zero byte.
inline constexpr size_t kMaximumLcmChannelBytes = 63;
/// The size of the largest content that LCM sends.
inline constexpr uint32_t kMaximumLcmMessageBytes = uint32_t{1} << 28;

struct AssembledMessage {
  std::string channel;  ///< 1 to kMaximumLcmChannelBytes bytes
  std::vector<std::byte> content;
};

class MessageAssembler {
 public:
  /// The default limit of the memory for all incomplete messages, roughly. A single message may take more, up
  /// to kMaximumLcmMessageBytes, if so many of its bytes have arrived.
  static constexpr size_t kMemoryBytes = size_t{64} << 20;
  /// A message is given up if no further fragment of it arrives for so long.
  static constexpr int64_t kPatienceUs = 10'000'000;

  explicit MessageAssembler(size_t memory_limit_bytes = kMemoryBytes)
      : memory_limit_bytes_(memory_limit_bytes) {}

  /// Adds a datagram and returns a message if the datagram is a complete message or completes one; otherwise
  /// nullopt. `sender` is the sender's IPv4 address and port as one number, `utime` the time of arrival in
  /// microseconds.
  ///
  /// Refuses a datagram that is not LCM's, a fragment that reaches beyond its message, and a fragment that
  /// contradicts an earlier one of the same message: by its message's size or count, by other data under the
  /// same number, or by an overlap. An exact repetition of a fragment changes nothing. If the memory limit is
  /// reached, gives up the message that has waited longest for a fragment.
  std::optional<AssembledMessage> Add(std::span<const std::byte> datagram, uint64_t sender, int64_t utime);

  int64_t refused_datagrams() const { return refused_datagrams_; }
  /// The number of messages that began and did not become complete: those given up, those whose fragments
  /// left a hole, and those that still wait for fragments.
  int64_t incomplete_messages() const { return given_up_ + static_cast<int64_t>(messages_.size()); }
  /// The memory of the messages that still wait for fragments, bytes.
  size_t memory_bytes() const { return memory_bytes_; }

 private:
  using Key = std::pair<uint64_t, uint32_t>;  // sender and sequence

  struct Fragment {
    uint32_t sequence;
    uint32_t message_bytes;
    uint32_t offset;
    uint16_t number;
    uint16_t count;
    std::span<const std::byte> data;
    std::string_view channel = {};  // empty unless this is fragment 0
  };

  struct Part {
    uint32_t offset;
    std::vector<std::byte> data;
  };

  struct Incomplete {
    Key key;
    uint32_t message_bytes;
    uint16_t count;
    int64_t touched_utime = 0;
    std::string channel = {};
    std::map<uint16_t, Part> parts = {};  // by fragment number; the offsets ascend, too
    size_t arrived_bytes = 0;             // of all parts together
  };
  using Messages = std::list<Incomplete>;

  static std::optional<Fragment> ParseFragment(std::span<const std::byte> datagram);
  static bool Agrees(const Incomplete& message, const Fragment& fragment);
  static bool Repeats(const Incomplete& message, const Part& part, const Fragment& fragment);
  static size_t MemoryBytes(const Incomplete& message);

  std::optional<AssembledMessage> AddWhole(std::span<const std::byte> datagram);
  std::optional<AssembledMessage> AddFragment(const Fragment& fragment, uint64_t sender, int64_t utime);
  std::optional<AssembledMessage> Refuse();
  Messages::iterator FindOrBegin(const Fragment& fragment, uint64_t sender);
  void Store(const Fragment& fragment, Incomplete& message);
  std::optional<AssembledMessage> Finish(Messages::iterator message);
  Incomplete Remove(Messages::iterator message);
  void GiveUpTheSilent(int64_t utime);

  size_t memory_limit_bytes_;
  size_t memory_bytes_ = 0;
  Messages messages_;  // sorted: the first has waited longest for a fragment
  std::map<Key, Messages::iterator> by_key_;
  int64_t refused_datagrams_ = 0;
  int64_t given_up_ = 0;
};

}  // namespace fresco
