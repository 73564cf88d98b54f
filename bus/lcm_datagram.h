// The format of the datagrams that LCM sends over UDP multicast. A datagram is a whole message or a fragment
// of one. All numbers are big-endian, and a zero byte ends the channel's name:
//
//   whole message: "LC02", uint32 sequence, channel, content
//   fragment:      "LC03", uint32 sequence, uint32 message_bytes, uint32 offset, uint16 number, uint16 count,
//                  in fragment 0 the channel, data
//
// `message_bytes` is the size of the whole content, and `offset` is the position of the fragment's data in
// it. Fragments with the same sender and sequence belong to the same message.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fresco {

inline constexpr uint32_t kWholeMessageMagic = 0x4C433032;  // "LC02"
inline constexpr uint32_t kFragmentMagic = 0x4C433033;      // "LC03"
inline constexpr size_t kWholeMessageHeaderBytes = 8;
inline constexpr size_t kFragmentHeaderBytes = 20;
/// The length of the longest channel name, without the zero byte.
inline constexpr size_t kMaximumLcmChannelBytes = 63;
/// The size of the largest content that LCM sends.
inline constexpr uint32_t kMaximumLcmMessageBytes = uint32_t{1} << 28;

}  // namespace fresco
