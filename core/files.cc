#include "core/files.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {
namespace {

constexpr char kTemporary[] = ".tmp";  // and the process id

/// Closes its descriptor; `Fail` throws with the cause that errno names.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags)
      : path_(path), fd_(::open(path.c_str(), flags, 0644)) {
    if (fd_ < 0) {
      Fail("open");
    }
  }
  ~Descriptor() {
    if (fd_ >= 0) {
      ::close(fd_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void WriteAll(std::string_view content) {
    while (!content.empty()) {
      const ssize_t written = ::write(fd_, content.data(), content.size());
      if (written >= 0) {
        content.remove_prefix(static_cast<size_t>(written));
      } else if (errno != EINTR) {
        Fail("write");
      }
    }
  }

  void Sync() {
    if (::fsync(fd_) != 0) {
      Fail("sync");
    }
  }

 private:
  [[noreturn]] void Fail(const char* action) const {
    throw Failure("can't " + std::string(action) + " " + path_.string() + ": " + std::strerror(errno));
  }

  std::filesystem::path path_;
  int fd_;
};

}  // namespace

void WriteFileAtomically(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path temporary = path;
  temporary += kTemporary + std::to_string(::getpid());
  try {
    {
      Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC);
      file.WriteAll(content);
      file.Sync();
    }
    if (std::rename(temporary.c_str(), path.c_str()) != 0) {
      throw Failure("can't rename " + temporary.string() + " to " + path.string() + ": " +
                    std::strerror(errno));
    }
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
  Descriptor(parent, O_RDONLY | O_DIRECTORY | O_CLOEXEC).Sync();
}

bool IsTemporaryOfAtomicFile(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return extension.starts_with(kTemporary) && extension.size() > sizeof kTemporary - 1 &&
         extension.find_first_not_of("0123456789", sizeof kTemporary - 1) == std::string::npos;
}

std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream content;
  if (!stream || std::filesystem::is_directory(path) ||
      !(content << stream.rdbuf() || stream.peek() == EOF)) {
    throw UsageError("can't read " + path.string() + ": " +
                     (std::filesystem::is_directory(path) ? "it is a directory" : std::strerror(errno)));
  }
  return content.str();
}

void CheckOutputFolder(const std::filesystem::path& folder, const std::string& option) {
  std::error_code error;  // a path that can't be looked at counts as not there; its parent tells why
  std::filesystem::path there = std::filesystem::absolute(folder);
  while (!std::filesystem::exists(there, error) && there.has_relative_path()) {
    there = there.parent_path();
  }
  if (!std::filesystem::is_directory(there, error)) {
    throw UsageError(option + ": can't make the folder " + folder.string() + ": " + there.string() +
                     " is not a folder");
  }
  if (::faccessat(AT_FDCWD, there.c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
    throw UsageError(option + ": can't write to the folder " + folder.string() + ": " + there.string() +
                     ": " + std::strerror(errno));
  }
}

FolderLock::FolderLock(const std::filesystem::path& folder, int64_t patience_us)
    : fd_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (fd_ < 0) {
    throw UsageError("can't open the folder " + folder.string() + ": " + std::strerror(errno));
  }
  const int64_t deadline_us = MonotonicMicroseconds() + patience_us;
  while (::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    if (MonotonicMicroseconds() >= deadline_us) {
      ::close(fd_);
      throw UsageError(folder.string() + ": another process is at work in this folder; end it first");
    }
    constexpr int kPauseMs = 20;
    ::poll(nullptr, 0, kPauseMs);
  }
}

FolderLock::~FolderLock() {
  ::close(fd_);
}

}  // namespace fresco
