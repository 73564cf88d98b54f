#include "core/folder_lock.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {

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
