// An event log of any bytes: read whole, and as a log that grows by a half. What is handed out stands in the
// file, in its order; every byte is an event's, damaged or torn.
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "core/error.h"
#include "logs/event_log_reader.h"
#include "tests/fuzz/fuzz_input.h"

namespace fresco {
namespace {

/// A file in memory.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("log", 0)) { FRESCO_CHECK(descriptor_ >= 0); }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  void Append(std::string_view bytes) {
    FRESCO_CHECK(write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  }
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// Reads to the end; returns the bytes of events.
int64_t ReadToTheEnd(EventLogReader& reader, std::string_view content) {
  constexpr int64_t kHeaderBytes = 28;
  int64_t bytes = 0;
  while (const auto event = reader.Next()) {
    const auto size = event->channel.size() + event->message.size();
    bytes += kHeaderBytes + static_cast<int64_t>(size);
    FRESCO_CHECK(!event->channel.empty());
    const auto begin = static_cast<size_t>(reader.position()) - size;
    FRESCO_CHECK(content.substr(begin, event->channel.size()) == event->channel);
    FRESCO_CHECK(event->message.empty() ||
                 static_cast<unsigned char>(content[static_cast<size_t>(reader.position()) - 1]) ==
                     std::to_integer<unsigned char>(event->message.back()));
  }
  return bytes;
}

void CheckWhole(std::string_view content) {
  MemoryFile file;
  file.Append(content);
  EventLogReader reader(file.path());
  const int64_t bytes = ReadToTheEnd(reader, content);
  FRESCO_CHECK(bytes + reader.damaged_bytes() + reader.torn_bytes() == static_cast<int64_t>(content.size()));
  FRESCO_CHECK(!reader.Next());
}

void CheckGrowing(std::string_view content) {
  MemoryFile file;
  file.Append(content.substr(0, content.size() / 2));
  EventLogReader reader(file.path());
  int64_t bytes = ReadToTheEnd(reader, content);
  file.Append(content.substr(content.size() / 2));
  bytes += ReadToTheEnd(reader, content);
  FRESCO_CHECK(bytes + reader.damaged_bytes() + reader.torn_bytes() == static_cast<int64_t>(content.size()));
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace fresco;
  const std::string_view content = TextOf(data, size);
  Accepts([&] { CheckWhole(content); });
  Accepts([&] { CheckGrowing(content); });
  return 0;
}
