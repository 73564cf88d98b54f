#include "logs/mcap_writer.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace fresco {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr size_t kChunkBytes = 1 << 20;

enum class McapRecord : uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

uint32_t McapCrc(std::string_view bytes, uint32_t previous = 0) {
  return static_cast<uint32_t>(
      crc32_z(previous, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

template <class Unsigned>
std::string LittleEndian(Unsigned value) {
  std::string bytes;
  for (size_t i = 0; i < sizeof(value); ++i) {
    bytes += static_cast<char>(uint64_t{value} >> (8 * i) & 0xff);
  }
  return bytes;
}

/// Texts, lists and maps begin with their length in bytes.
std::string WithLength(std::string_view content) {
  return LittleEndian(static_cast<uint32_t>(content.size())).append(content);
}

/// What stands before the content of a record.
std::string RecordHeader(McapRecord kind, size_t content_bytes) {
  return LittleEndian(static_cast<uint8_t>(kind)) + LittleEndian(uint64_t{content_bytes});
}

std::string Record(McapRecord kind, std::string_view content) {
  return RecordHeader(kind, content.size()).append(content);
}

}  // namespace

void McapWriter::Statistics::Count(uint64_t time_ns) {
  first_ns = messages == 0 ? time_ns : std::min(first_ns, time_ns);
  last_ns = std::max(last_ns, time_ns);
  ++messages;
}

McapWriter::McapWriter(TextOutput& output) : output_(output) {
  Emit(kMagic);
  Emit(Record(McapRecord::kHeader, WithLength("") + WithLength("fresco")));
}

uint16_t McapWriter::AddChannel(const std::string& topic, const McapSchema& schema) {
  if (channel_messages_.size() == std::numeric_limits<uint16_t>::max()) {
    throw Failure(
        "an MCAP file has at most 65535 channels, and the logs have more; export some of them (--channel)");
  }
  const auto next_schema = static_cast<uint16_t>(schema_ids_.size() + 1);
  const auto [found, is_new] = schema_ids_.try_emplace({schema.name, schema.content}, next_schema);
  if (is_new) {
    const std::string record =
        Record(McapRecord::kSchema, LittleEndian(next_schema) + WithLength(schema.name) +
                                        WithLength(schema.encoding) + WithLength(schema.content));
    schemas_ += record;
    chunk_ += record;
  }
  channel_messages_.push_back(0);
  const auto channel = static_cast<uint16_t>(channel_messages_.size());
  const std::string record =
      Record(McapRecord::kChannel, LittleEndian(channel) + LittleEndian(found->second) + WithLength(topic) +
                                       WithLength(schema.encoding) + WithLength(""));  // no metadata
  channels_ += record;
  chunk_ += record;
  return channel;
}

void McapWriter::Write(const McapMessage& message) {
  uint64_t& number = channel_messages_.at(message.channel - size_t{1});
  const std::string header = LittleEndian(message.channel) + LittleEndian(static_cast<uint32_t>(number)) +
                             LittleEndian(message.log_time_ns) + LittleEndian(message.publish_time_ns);
  chunk_index_[message.channel] += LittleEndian(message.log_time_ns) + LittleEndian(uint64_t{chunk_.size()});
  chunk_ += RecordHeader(McapRecord::kMessage, header.size() + message.content.size());
  chunk_ += header;
  chunk_ += message.content;
  ++number;
  chunk_statistics_.Count(message.log_time_ns);
  statistics_.Count(message.log_time_ns);
  if (chunk_.size() >= kChunkBytes) {
    EndChunk();
  }
}

void McapWriter::EndChunk() {
  if (chunk_.empty()) {
    return;
  }
  const uint64_t begin = position_;
  const std::string times =
      LittleEndian(chunk_statistics_.first_ns) + LittleEndian(chunk_statistics_.last_ns);
  const std::string size = LittleEndian(uint64_t{chunk_.size()});
  const std::string header = times + size + LittleEndian(McapCrc(chunk_)) + WithLength("") + size;
  Emit(RecordHeader(McapRecord::kChunk, header.size() + chunk_.size()) + header);
  Emit(chunk_);
  const uint64_t end = position_;
  std::string index_places;
  for (const auto& [channel, entries] : chunk_index_) {
    index_places += LittleEndian(channel) + LittleEndian(position_);
    Emit(Record(McapRecord::kMessageIndex, LittleEndian(channel) + WithLength(entries)));
  }
  chunk_indexes_ += Record(McapRecord::kChunkIndex,
                           times + LittleEndian(begin) + LittleEndian(end - begin) +
                               WithLength(index_places) + LittleEndian(position_ - end) + WithLength("") +
                               size + size);  // compressed and uncompressed
  ++chunks_;
  chunk_.clear();
  chunk_index_.clear();
  chunk_statistics_ = {};
}

void McapWriter::Finish() {
  EndChunk();
  Emit(Record(McapRecord::kDataEnd, LittleEndian(crc_)));
  std::string counts;
  for (size_t i = 0; i < channel_messages_.size(); ++i) {
    counts += LittleEndian(static_cast<uint16_t>(i + 1)) + LittleEndian(channel_messages_[i]);
  }
  const std::string no_attachments_and_metadata = LittleEndian(uint32_t{0}) + LittleEndian(uint32_t{0});
  const std::string statistics =
      Record(McapRecord::kStatistics,
             LittleEndian(statistics_.messages) + LittleEndian(static_cast<uint16_t>(schema_ids_.size())) +
                 LittleEndian(static_cast<uint32_t>(channel_messages_.size())) + no_attachments_and_metadata +
                 LittleEndian(chunks_) + LittleEndian(statistics_.first_ns) +
                 LittleEndian(statistics_.last_ns) + WithLength(counts));
  const uint64_t begin = position_;
  std::string summary;
  std::string offsets;
  const auto add = [&](McapRecord kind, const std::string& records) {
    if (!records.empty()) {
      offsets += Record(McapRecord::kSummaryOffset, LittleEndian(static_cast<uint8_t>(kind)) +
                                                        LittleEndian(begin + summary.size()) +
                                                        LittleEndian(uint64_t{records.size()}));
      summary += records;
    }
  };
  add(McapRecord::kSchema, schemas_);
  add(McapRecord::kChannel, channels_);
  add(McapRecord::kStatistics, statistics);
  add(McapRecord::kChunkIndex, chunk_indexes_);
  const std::string places = LittleEndian(begin) + LittleEndian(begin + summary.size());
  summary += offsets + RecordHeader(McapRecord::kFooter, places.size() + sizeof(uint32_t)) + places;
  summary += LittleEndian(McapCrc(summary));
  Emit(summary);
  Emit(kMagic);
  output_.Flush();
}

void McapWriter::Emit(std::string_view bytes) {
  crc_ = McapCrc(bytes, crc_);
  position_ += bytes.size();
  output_.Write(bytes);
}

}  // namespace fresco
