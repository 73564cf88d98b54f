#include "logs/event_log_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/bytes.h"
#include "core/error.h"

namespace fresco {
namespace {

constexpr uint32_t kSyncWord = 0xEDA1DA01;
constexpr size_t kSyncBytes = 4;
constexpr size_t kBlockBytes = 1 << 20;
// The limits of LCM's own programs.
constexpr int32_t kMostChannelBytes = 999;
constexpr int32_t kMostMessageBytes = 1 << 28;

bool IsSyncWord(const std::byte* bytes) {
  return ReadBigEndian<uint32_t>(bytes) == kSyncWord;
}

struct Header {
  explicit Header(const std::byte* bytes)
      : number(static_cast<int64_t>(ReadBigEndian<uint64_t>(bytes + 4))),
        utime(static_cast<int64_t>(ReadBigEndian<uint64_t>(bytes + 12))),
        channel_bytes(static_cast<int32_t>(ReadBigEndian<uint32_t>(bytes + 20))),
        message_bytes(static_cast<int32_t>(ReadBigEndian<uint32_t>(bytes + 24))),
        begins_with_sync_word(IsSyncWord(bytes)) {}

  bool IsPossible() const {
    return begins_with_sync_word && channel_bytes > 0 && channel_bytes <= kMostChannelBytes &&
           message_bytes >= 0 && message_bytes <= kMostMessageBytes;
  }
  size_t event_bytes() const {
    return kEventHeaderBytes + static_cast<size_t>(channel_bytes) + static_cast<size_t>(message_bytes);
  }

  int64_t number;
  int64_t utime;
  int32_t channel_bytes;
  int32_t message_bytes;
  bool begins_with_sync_word;
};

/// Returns the position of the first sync word; bytes.size() if there is none.
size_t FindSyncWord(std::span<const std::byte> bytes) {
  static constexpr std::array<unsigned char, kSyncBytes> kWord = {0xED, 0xA1, 0xDA, 0x01};
  const void* found = memmem(bytes.data(), bytes.size(), kWord.data(), kWord.size());
  return found == nullptr ? bytes.size()
                          : static_cast<size_t>(static_cast<const std::byte*>(found) - bytes.data());
}

}  // namespace

EventLogReader::EventLogReader(std::filesystem::path path, Beginning beginning)
    : path_(std::move(path)), descriptor_(open(path_.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    throw UsageError(fmt::format("can't read {}: {}", path_.string(), std::strerror(errno)));
  }
  try {
    const bool is_file = std::filesystem::is_regular_file(path_);
    if (!is_file ||
        (beginning == Beginning::kSound && Buffer(kSyncBytes) && !IsSyncWord(buffered().data()))) {
      throw UsageError(fmt::format(
          "{}: expected an LCM event log, as lcm-logger and fresco log record write them; found a file that "
          "does not begin with the sync word ED A1 DA 01",
          path_.string()));
    }
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

EventLogReader::~EventLogReader() {
  close(descriptor_);
}

std::optional<LcmEvent> EventLogReader::Next() {
  torn_bytes_ = 0;
  while (Buffer(kEventHeaderBytes)) {
    const Header header(buffered().data());
    if (header.IsPossible() && Buffer(header.event_bytes())) {
      if (!SwallowsAnother(header.event_bytes())) {
        return Consume(header.event_bytes(), static_cast<size_t>(header.channel_bytes));
      }
    } else if (header.IsPossible() && !HasWholeEvent(FileBytes())) {
      break;
    }
    SkipDamage();
  }
  torn_bytes_ = FileBytes() - position_;
  return std::nullopt;
}

LcmEvent EventLogReader::Consume(size_t event_bytes, size_t channel_bytes) {
  const auto event = buffered().first(event_bytes);
  const Header header(event.data());
  begin_ += event_bytes;
  position_ += static_cast<int64_t>(event_bytes);
  return {header.number,
          header.utime,
          {reinterpret_cast<const char*>(event.data()) + kEventHeaderBytes, channel_bytes},
          event.subspan(kEventHeaderBytes + channel_bytes)};
}

/// Whether the length of the current event is damaged: no event begins behind its end, but one begins inside
/// it.
bool EventLogReader::SwallowsAnother(size_t event_bytes) {
  if (!Buffer(event_bytes + kSyncBytes) || IsSyncWord(buffered().data() + event_bytes)) {
    return false;
  }
  return HasWholeEvent(position_ + static_cast<int64_t>(event_bytes));
}

/// Whether a complete event begins between the beginning of the current one and `end`. Behind it there must
/// be another event or the file's end, since a message may contain the bytes of a sync word.
bool EventLogReader::HasWholeEvent(int64_t end) {
  if (whole_event_ > position_) {
    return whole_event_ < end;
  }
  int64_t offset = position_ + static_cast<int64_t>(kSyncBytes);
  std::vector<std::byte> block;
  std::span<const std::byte> rest;  // the part of the block from `offset` on
  while (offset < end) {
    if (rest.size() < kSyncBytes) {
      block.resize(std::min(kBlockBytes, static_cast<size_t>(end - offset) + kSyncBytes - 1));
      rest = std::span<const std::byte>(block).first(ReadAt(offset, block));
      if (rest.size() < kSyncBytes) {
        return false;
      }
    }
    const size_t found = FindSyncWord(rest);
    const bool is_there = found < rest.size();
    if (is_there && WholeEventBeginsAt(offset + static_cast<int64_t>(found))) {
      whole_event_ = offset + static_cast<int64_t>(found);
      return true;
    }
    const size_t passed = is_there ? found + kSyncBytes : rest.size() - (kSyncBytes - 1);
    offset += static_cast<int64_t>(passed);
    rest = rest.subspan(passed);
  }
  return false;
}

bool EventLogReader::WholeEventBeginsAt(int64_t offset) const {
  std::array<std::byte, kEventHeaderBytes> bytes;
  if (ReadAt(offset, bytes) < kEventHeaderBytes || !Header(bytes.data()).IsPossible()) {
    return false;
  }
  const int64_t end = offset + static_cast<int64_t>(Header(bytes.data()).event_bytes());
  const bool has_next = ReadAt(end, std::span(bytes).first(kSyncBytes)) == kSyncBytes;
  return end == FileBytes() || (has_next && IsSyncWord(bytes.data()));
}

/// Skips to the next sync word behind the current one.
void EventLogReader::SkipDamage() {
  size_t from = 1;
  while (true) {
    const size_t found = from + FindSyncWord(buffered().subspan(from));
    const bool is_there = found < buffered().size();
    // Keep the last bytes: they may be the beginning of a sync word.
    const size_t skipped = is_there ? found : buffered().size() - (kSyncBytes - 1);
    begin_ += skipped;
    position_ += static_cast<int64_t>(skipped);
    damaged_bytes_ += static_cast<int64_t>(skipped);
    if (is_there || !Buffer(kEventHeaderBytes)) {
      return;
    }
    from = 0;
  }
}

std::span<const std::byte> EventLogReader::buffered() const {
  return std::span(block_).subspan(begin_, end_ - begin_);
}

/// Makes sure that this many bytes are buffered. Returns false if the file does not have as many.
bool EventLogReader::Buffer(size_t bytes) {
  if (end_ - begin_ >= bytes) {
    return true;
  }
  const int64_t file_bytes = FileBytes();
  if (position_ + static_cast<int64_t>(bytes) > file_bytes) {
    return false;
  }
  std::move(block_.begin() + static_cast<ptrdiff_t>(begin_), block_.begin() + static_cast<ptrdiff_t>(end_),
            block_.begin());
  end_ -= std::exchange(begin_, 0);
  block_.resize(std::max({block_.size(), bytes, std::min(kBlockBytes, static_cast<size_t>(file_bytes))}));
  end_ += ReadAt(position_ + static_cast<int64_t>(end_), std::span(block_).subspan(end_));
  return end_ >= bytes;
}

/// Reads from `offset` into `bytes`. Returns the number of bytes read, which is smaller at the end of the
/// file.
size_t EventLogReader::ReadAt(int64_t offset, std::span<std::byte> bytes) const {
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t now =
        pread(descriptor_, bytes.data() + done, bytes.size() - done, offset + static_cast<int64_t>(done));
    if (now < 0 && errno != EINTR) {
      throw Failure(fmt::format("can't read {}: {}", path_.string(), std::strerror(errno)));
    }
    if (now == 0) {
      break;
    }
    done += static_cast<size_t>(std::max<ssize_t>(now, 0));
  }
  return done;
}

int64_t EventLogReader::FileBytes() const {
  struct stat status {};
  if (fstat(descriptor_, &status) != 0) {
    throw Failure(fmt::format("can't read {}: {}", path_.string(), std::strerror(errno)));
  }
  return status.st_size;
}

}  // namespace fresco
