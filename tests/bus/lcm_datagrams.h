// Datagrams as LCM's documentation has them, with any numbers in them.
#pragma once

#include <cstdint>
#include <string>

#include "tests/logs/event_log_files.h"

namespace fresco {

struct FragmentFields {
  uint32_t sequence = 7;
  uint32_t message_bytes = 0;
  uint32_t offset = 0;
  uint32_t number = 0;
  uint32_t count = 0;
};

/// `rest` is the channel, a zero and the content.
inline std::string WholeDatagram(const std::string& rest) {
  return "LC02" + BigEndian(0, 4) + rest;
}

/// `rest` is the data, in fragment 0 behind the channel and a zero.
inline std::string FragmentDatagram(const FragmentFields& fields, const std::string& rest) {
  return "LC03" + BigEndian(fields.sequence, 4) + BigEndian(fields.message_bytes, 4) +
         BigEndian(fields.offset, 4) + BigEndian(fields.number, 2) + BigEndian(fields.count, 2) + rest;
}

/// The channel A and what stands behind it.
inline std::string OnA(const std::string& content) {
  return std::string("A\0", 2) + content;
}

}  // namespace fresco
