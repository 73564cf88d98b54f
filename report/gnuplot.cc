#include "report/gnuplot.h"

#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {
namespace {

/// A file in memory, used for gnuplot's input and output instead of a pipe. Neither side waits for the other,
/// so there are no full or closed pipes to handle.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name) : fd_(memfd_create(name, MFD_CLOEXEC)) {
    if (fd_ < 0) {
      Fail("make");
    }
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int fd() const { return fd_; }

  void Write(std::string_view content) {
    while (!content.empty()) {
      const ssize_t written = write(fd_, content.data(), content.size());
      if (written < 0 && errno != EINTR) {
        Fail("write");
      }
      content.remove_prefix(static_cast<size_t>(std::max<ssize_t>(written, 0)));
    }
    lseek(fd_, 0, SEEK_SET);
  }

  std::string Content() const {
    std::string content(static_cast<size_t>(std::max<off_t>(lseek(fd_, 0, SEEK_END), 0)), '\0');
    size_t size = 0;
    while (size < content.size()) {
      const ssize_t got = pread(fd_, content.data() + size, content.size() - size, static_cast<off_t>(size));
      if (got == 0 || (got < 0 && errno != EINTR)) {
        Fail("read");
      }
      size += static_cast<size_t>(std::max<ssize_t>(got, 0));
    }
    return content;
  }

 private:
  [[noreturn]] static void Fail(const char* action) {
    throw Failure(std::string("gnuplot: can't ") + action + " a file in memory: " + std::strerror(errno));
  }

  int fd_;
};

/// The two descriptions of the child that posix_spawn needs: its standard streams, and its signals. It gets a
/// process group of its own, so that Ctrl-C in a terminal reaches the parent only.
class SpawnSettings {
 public:
  SpawnSettings(int input, int output, int errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
    posix_spawnattr_init(&attributes_);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  /// Starts the program, which is searched for in PATH, and returns its process id.
  pid_t Spawn(char* const* arguments) const {
    pid_t pid = -1;
    const int error = posix_spawnp(&pid, arguments[0], &actions_, &attributes_, arguments, environ);
    if (error == ENOENT) {
      throw Failure(
          "figures are drawn by the program gnuplot, which is not in PATH; install the Debian package "
          "gnuplot-nox (apt-get install gnuplot-nox)");
    }
    if (error != 0) {
      throw Failure(std::string("can't start gnuplot: ") + std::strerror(error));
    }
    return pid;
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

/// Waits for the child and returns its wait status. After `timeout_us`, kills it and all that it has started,
/// and throws Failure.
int Wait(pid_t pid, int64_t timeout_us) {
  const int64_t deadline_us = MonotonicMicroseconds() + timeout_us;
  int status = 0;
  while (waitpid(pid, &status, WNOHANG) == 0) {
    if (MonotonicMicroseconds() > deadline_us) {
      kill(-pid, SIGKILL);
      waitpid(pid, &status, 0);
      throw Failure("gnuplot did not finish within " + std::to_string(timeout_us / 1000) +
                    " ms and was killed");
    }
    constexpr int kWaitMs = 2;
    poll(nullptr, 0, kWaitMs);
  }
  return status;
}

std::string StatusText(int status) {
  return WIFEXITED(status) ? "exit status " + std::to_string(WEXITSTATUS(status))
                           : "signal " + std::to_string(WTERMSIG(status));
}

/// Returns the length of the UTF-8 sequence at the beginning of `text`; 0 if it is not valid or XML does not
/// allow it.
size_t Utf8Length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const size_t length = byte(0) < 0x80                      ? 1
                        : byte(0) >= 0xC2 && byte(0) < 0xE0 ? 2
                        : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3
                        : byte(0) >= 0xF0 && byte(0) < 0xF5 ? 4
                                                            : 0;
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) {
      return 0;
    }
  }
  const unsigned first_two = byte(0) << 8 | byte(1);
  const bool overlong = length > 2 && (first_two < 0xE0A0 || (first_two >= 0xF080 && first_two < 0xF090));
  const bool surrogate = length == 3 && first_two >= 0xEDA0 && first_two < 0xEE00;
  const bool beyond = length == 4 && first_two >= 0xF490;
  const bool not_a_character = length == 3 && first_two == 0xEFBF && byte(2) >= 0xBE;  // U+FFFE, U+FFFF
  return overlong || surrogate || beyond || not_a_character ? 0 : length;
}

/// Returns the character escaped. A backquote becomes "\\140", since it would run a command even after a
/// backslash.
std::string OctalEscape(char character) {
  const auto digit = [&](int shift) { return static_cast<char>('0' + ((character >> shift) & 7)); };
  return {'\\', digit(6), digit(3), digit(0)};
}

}  // namespace

std::string RunGnuplot(const std::string& script, int64_t timeout_us) {
  MemoryFile input("gnuplot-script");
  const MemoryFile output("gnuplot-output");
  const MemoryFile errors("gnuplot-errors");
  input.Write(script);
  std::string program = "gnuplot";
  std::string default_settings = "-d";
  char* const arguments[] = {program.data(), default_settings.data(), nullptr};
  const pid_t pid = SpawnSettings(input.fd(), output.fd(), errors.fd()).Spawn(arguments);
  const int status = Wait(pid, timeout_us);
  if (status != 0) {
    throw Failure("gnuplot failed with " + StatusText(status) + ": " + errors.Content());
  }
  return output.Content();
}

std::string GnuplotString(std::string_view text) {
  std::string quoted = "\"";
  while (!text.empty()) {
    const size_t length = Utf8Length(text);
    const std::string_view character = text.substr(0, std::max<size_t>(length, 1));
    text.remove_prefix(character.size());
    if (length == 0) {
      quoted += "\uFFFD";
    } else if (length == 1 && (static_cast<unsigned char>(character[0]) < 0x20 || character[0] == 0x7F)) {
      quoted += ' ';
    } else if (character == ">" && quoted.ends_with("]]")) {
      quoted += " >";  // gnuplot does not escape ">", and XML does not allow "]]>" in text
    } else if (std::string_view("\"\\`").find(character) != std::string_view::npos) {
      quoted += OctalEscape(character[0]);
    } else {
      quoted += character;
    }
  }
  return quoted + "\"";
}

}  // namespace fresco
