// What LCM sends over UDP multicast. A datagram is a whole message or a fragment of one; all numbers are
// big-endian, and a channel's name has a zero behind it:
//
//   whole message: "LC02", uint32 sequence, channel, content
//   fragment:      "LC03", uint32 sequence, uint32 message_bytes, uint32 offset, uint16 number, uint16 count,
//                  in fragment 0 the channel, data
//
// `message_bytes` is the size of the content, `offset` the place of the data in it. Fragments belong to the
// same message if their sender and sequence are the same.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fresco {

inline constexpr uint32_t kWholeMessageMagic = 0x4C433032;  // "LC02"
inline constexpr uint32_t kFragmentMagic = 0x4C433033;      // "LC03"
inline constexpr size_t kWholeMessageHeaderBytes = 8;
inline constexpr size_t kFragmentHeaderBytes = 20;
/// The longest name of a channel, without its zero.
inline constexpr size_t kMaximumLcmChannelBytes = 63;
/// LCM sends no larger content.
inline constexpr uint32_t kMaximumLcmMessageBytes = uint32_t{1} << 28;

}  // namespace fresco
