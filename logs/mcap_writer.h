// Writes an MCAP file (https://mcap.dev/spec) whose messages can be found by time and channel: in chunks of
// about a megabyte, uncompressed, each with an index, and with a summary at the end. Only one thread may use
// an object.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "logs/row_writer.h"

namespace fresco {

struct McapSchema {
  std::string name;
  std::string encoding;  ///< of the schema and of the messages: for Protobuf, both are called "protobuf"
  std::string content;
};

struct McapMessage {
  uint16_t channel;
  uint64_t log_time_ns;      ///< since the epoch, when it was recorded
  uint64_t publish_time_ns;  ///< since the epoch, when it was sent
  std::string_view content;
};

class McapWriter {
 public:
  /// `output` must outlive the object. Throws as its Write does; the other functions do, too.
  explicit McapWriter(TextOutput& output);

  /// Returns the number of a new channel. Topics need not differ. Throws Failure if there are too many for
  /// the format (65,535).
  uint16_t AddChannel(const std::string& topic, const McapSchema& schema);

  /// Appends a message to a channel that AddChannel returned.
  void Write(const McapMessage& message);

  /// Ends the file. Without it, the messages can be read, but not found by the index.
  void Finish();

  int64_t messages() const { return static_cast<int64_t>(statistics_.messages); }

 private:
  struct Statistics {
    uint64_t messages = 0;
    uint64_t first_ns = 0;
    uint64_t last_ns = 0;
    void Count(uint64_t time_ns);
  };

  void EndChunk();
  void Emit(std::string_view bytes);

  TextOutput& output_;
  uint64_t position_ = 0;
  uint32_t crc_ = 0;  // of everything before `position_`

  std::string chunk_;  // its records
  Statistics chunk_statistics_;
  std::map<uint16_t, std::string> chunk_index_;  // by channel: time and place of each message

  Statistics statistics_;
  uint32_t chunks_ = 0;
  std::map<std::pair<std::string, std::string>, uint16_t> schema_ids_;  // by name and content
  std::vector<uint64_t> channel_messages_;                              // of channel 1, 2, ..
  // Records of the summary.
  std::string schemas_;
  std::string channels_;
  std::string chunk_indexes_;
};

}  // namespace fresco
