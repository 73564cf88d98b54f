// MCAP files, read by a parser of the test's own, made after https://mcap.dev/spec.
#include "logs/mcap_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/error.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

/// CRC-32 as ISO 3309 defines it, bit by bit.
uint32_t LiteralCrc32(std::string_view bytes) {
  uint32_t crc = 0xffffffff;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) {
      crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320u : 0u);
    }
  }
  return ~crc;
}

/// Takes values from bytes, one behind the other.
class McapBytes {
 public:
  explicit McapBytes(std::string_view bytes) : bytes_(bytes) {}
  uint64_t Number(size_t size) {
    uint64_t value = 0;
    for (size_t i = 0; i < size; ++i) {
      value |= uint64_t{static_cast<unsigned char>(bytes_.at(i))} << (8 * i);
    }
    bytes_.remove_prefix(size);
    return value;
  }
  std::string Take(size_t size) {
    const std::string taken(bytes_.substr(0, size));
    EXPECT_EQ(taken.size(), size);
    bytes_.remove_prefix(size);
    return taken;
  }
  std::string Text() { return Take(Number(4)); }
  bool empty() const { return bytes_.empty(); }
  std::string_view rest() const { return bytes_; }

 private:
  std::string_view bytes_;
};

struct McapTestRecord {
  int kind;
  size_t begin;  // in its file or chunk
  std::string content;
};

std::vector<McapTestRecord> RecordsIn(std::string_view bytes, size_t begin = 0) {
  std::vector<McapTestRecord> records;
  McapBytes reader(bytes);
  while (!reader.empty()) {
    const size_t position = begin + bytes.size() - reader.rest().size();
    const int kind = static_cast<int>(reader.Number(1));
    records.push_back({kind, position, reader.Take(reader.Number(8))});
  }
  return records;
}

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

std::string McapFileOf(const std::function<void(McapWriter&)>& write) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "file";
  TextOutput output(path);
  McapWriter writer(output);
  write(writer);
  writer.Finish();
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

std::vector<McapTestRecord> RecordsOfFile(const std::string& file) {
  EXPECT_TRUE(file.starts_with(kMcapMagic) && file.ends_with(kMcapMagic));
  return RecordsIn(std::string_view(file).substr(8, file.size() - 16), 8);
}

constexpr int kMcapTestMessages = 5000;  // of 1000 bytes: several chunks

TEST(McapWriter, WritesMessagesThatTheIndexFinds) {
  const std::string file = McapFileOf([](McapWriter& writer) {
    EXPECT_EQ(writer.AddChannel("A", {"fresco.a_t", "protobuf", "description"}), 1);
    for (int i = 0; i < kMcapTestMessages; ++i) {
      if (i == 100) {
        EXPECT_EQ(writer.AddChannel("B", {"fresco.a_t", "protobuf", "description"}), 2);
      }
      const auto channel = static_cast<uint16_t>(i < 100 ? 1 : 1 + i % 2);
      writer.Write({channel, uint64_t(1000 + i), uint64_t(i), std::string(1000, static_cast<char>(i))});
    }
    EXPECT_EQ(writer.messages(), kMcapTestMessages);
  });
  int messages = 0;
  int chunks = 0;
  int indexed = 0;
  std::vector<McapTestRecord> chunk;
  std::map<uint64_t, size_t> chunk_lengths;  // by position
  std::vector<int> kinds;
  for (const McapTestRecord& record : RecordsOfFile(file)) {
    McapBytes content(record.content);
    if (kinds.empty() || kinds.back() != record.kind) {
      kinds.push_back(record.kind);
    }
    if (record.kind == 0x06) {
      ++chunks;
      chunk_lengths[record.begin] = 9 + record.content.size();
      const uint64_t first = content.Number(8);
      const uint64_t last = content.Number(8);
      EXPECT_EQ(first, uint64_t(1000 + messages));
      const uint64_t size = content.Number(8);
      const uint64_t crc = content.Number(4);
      EXPECT_EQ(content.Text(), "");
      EXPECT_EQ(content.Number(8), size);
      EXPECT_EQ(crc, LiteralCrc32(content.rest()));
      chunk = RecordsIn(content.rest());
      for (const McapTestRecord& inner : chunk) {
        messages += inner.kind == 0x05 ? 1 : 0;
      }
      EXPECT_EQ(last, uint64_t(1000 + messages - 1));
    } else if (record.kind == 0x07) {
      const uint64_t channel = content.Number(2);
      content.Number(4);
      while (!content.empty()) {
        const uint64_t time = content.Number(8);
        const uint64_t offset = content.Number(8);
        const auto found = std::find_if(chunk.begin(), chunk.end(),
                                        [&](const McapTestRecord& inner) { return inner.begin == offset; });
        ASSERT_NE(found, chunk.end());
        EXPECT_EQ(found->kind, 0x05);
        McapBytes message(found->content);
        EXPECT_EQ(message.Number(2), channel);
        message.Number(4);
        EXPECT_EQ(message.Number(8), time);
        EXPECT_EQ(message.Number(8), time - 1000);
        EXPECT_EQ(message.rest(), std::string(1000, static_cast<char>(time - 1000)));
        ++indexed;
      }
    } else if (record.kind == 0x0F) {
      EXPECT_EQ(content.Number(4), LiteralCrc32(std::string_view(file).substr(0, record.begin)));
    } else if (record.kind == 0x08) {
      content.Take(16);
      const uint64_t begin = content.Number(8);
      EXPECT_EQ(content.Number(8), chunk_lengths.at(begin));
    } else if (record.kind == 0x0B) {
      EXPECT_EQ(content.Number(8), uint64_t{kMcapTestMessages});
      EXPECT_EQ(content.Number(2), 1u);  // both channels have the same schema
      EXPECT_EQ(content.Number(4), 2u);
      content.Number(8);
      EXPECT_EQ(content.Number(4), uint64_t(chunks));
      EXPECT_EQ(content.Number(8), 1000u);
      EXPECT_EQ(content.Number(8), uint64_t{1000 + kMcapTestMessages - 1});
    } else if (record.kind == 0x0E) {
      content.Number(1);
      const uint64_t begin = content.Number(8);
      const auto group = RecordsIn(std::string_view(file).substr(begin, content.Number(8)), begin);
      for (const McapTestRecord& member : group) {
        EXPECT_EQ(member.kind, record.content[0]);
      }
    } else if (record.kind == 0x02) {
      const uint64_t begin = content.Number(8);
      EXPECT_EQ(file[begin], 0x03);
      EXPECT_EQ(file[content.Number(8)], 0x0E);
      EXPECT_EQ(content.Number(4),
                LiteralCrc32(std::string_view(file).substr(begin, record.begin + 9 + 16 - begin)));
    }
  }
  EXPECT_EQ(messages, kMcapTestMessages);
  EXPECT_EQ(indexed, kMcapTestMessages);
  EXPECT_GT(chunks, 3);
  EXPECT_EQ(kinds.front(), 0x01);
  EXPECT_EQ((std::vector<int>(kinds.end() - 7, kinds.end())),
            (std::vector<int>{0x0F, 0x03, 0x04, 0x0B, 0x08, 0x0E, 0x02}));
}

TEST(McapWriter, WritesAFileWithoutMessages) {
  std::vector<int> kinds;
  for (const McapTestRecord& record : RecordsOfFile(McapFileOf([](McapWriter&) {}))) {
    kinds.push_back(record.kind);
  }
  EXPECT_EQ(kinds, (std::vector<int>{0x01, 0x0F, 0x0B, 0x0E, 0x02}));
}

TEST(McapWriter, RefusesMoreChannelsThanTheFormatCanHave) {
  McapFileOf([](McapWriter& writer) {
    const McapSchema schema = {"s", "protobuf", ""};
    for (int i = 1; i <= 65'535; ++i) {
      ASSERT_EQ(writer.AddChannel("A", schema), i);
    }
    EXPECT_THAT(ErrorOf([&] { writer.AddChannel("A", schema); }, ErrorKind::kFailure),
                testing::HasSubstr("--channel"));
  });
}

}  // namespace
}  // namespace fresco
