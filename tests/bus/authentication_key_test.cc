// Key files: what is taken, and what is refused with the command that mends it.
#include "bus/authenticated_bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>

#include "bus/open_bus.h"
#include "tests/bus/text_messages.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using ::testing::HasSubstr;

class KeyFiles : public ::testing::Test {
 protected:
  std::filesystem::path Write(const std::string& content, mode_t mode = 0600) const {
    std::filesystem::path path = folder_.path() / "run.key";
    std::ofstream(path, std::ios::binary) << content;
    EXPECT_EQ(chmod(path.c_str(), mode), 0);
    return path;
  }

  static void ExpectRefused(const std::filesystem::path& path, const std::vector<std::string>& words) {
    const std::string error = ErrorOf([&] { ReadAuthenticationKey(path); });
    EXPECT_THAT(error, HasSubstr("--key-file: " + path.string()));
    for (const std::string& word : words) {
      EXPECT_THAT(error, HasSubstr(word));
    }
  }

  const TemporaryFolder folder_;
};

std::vector<unsigned char> KeyOf(const std::filesystem::path& path) {
  const AuthenticationKey key = ReadAuthenticationKey(path);
  return {key.bytes().begin(), key.bytes().end()};
}

// python3 -c "import hashlib; print(list(hashlib.blake2b(b'k' * 32, digest_size=32).digest()[:4]))", and
// the same with 65536
TEST_F(KeyFiles, GiveTheBlake2bOfTheirWholeContent) {
  const auto smallest = KeyOf(Write(std::string(kMinimumKeyFileBytes, 'k')));
  EXPECT_THAT(std::vector(smallest.begin(), smallest.begin() + 4), ::testing::ElementsAre(10, 138, 246, 224));
  const auto largest = KeyOf(Write(std::string(kMaximumKeyFileBytes, 'k'), 0400));
  EXPECT_THAT(std::vector(largest.begin(), largest.begin() + 4), ::testing::ElementsAre(85, 54, 39, 52));
}

TEST_F(KeyFiles, DifferWithTheLastByte) {
  const std::string content(100, 'k');
  EXPECT_NE(KeyOf(Write(content + "a")), KeyOf(Write(content + "b")));
  EXPECT_NE(KeyOf(Write(content)), KeyOf(Write(content + '\n')));
}

TEST_F(KeyFiles, AreRefusedWithTheCommandThatMakesOne) {
  const std::string command = "head -c 32 /dev/urandom > '";
  ExpectRefused(folder_.path() / "none", {"No such file", command + (folder_.path() / "none").string()});
  ExpectRefused(folder_.path(), {"regular file", "directory", command});
  ExpectRefused("", {"can't be read", command});
  ExpectRefused("/dev/null", {"regular file", command});
  ExpectRefused(Write(""), {"32 to 65536", "found 0", command});
  ExpectRefused(Write(std::string(kMinimumKeyFileBytes - 1, 'k')), {"32 to 65536", "found 31", command});
  ExpectRefused(Write(std::string(kMaximumKeyFileBytes + 1, 'k')), {"32 to 65536", "found more", command});
}

TEST_F(KeyFiles, AreRefusedWhereAPipeWouldBeWaitedFor) {
  const std::filesystem::path pipe = folder_.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  ExpectRefused(pipe, {"regular file", "pipe"});
}

TEST_F(KeyFiles, AreRefusedWhereOthersMayReadOrWriteThem) {
  for (const mode_t others : {0040, 0020, 0010, 0004, 0002, 0001}) {
    const auto path = Write(std::string(32, 'k'), 0600 | others);
    ExpectRefused(path, {"mode 600", "chmod 600 '" + path.string()});
  }
}

TEST_F(KeyFiles, OpenABusWithTheirKey) {
  const auto bus = OpenBus("memq://", {.key_file = Write(std::string(32, 'k'))});
  const std::string secret(32, 'k');
  const auto same = MakeAuthenticatedBus(*bus, AuthenticationKey(Bytes(secret)));
  int heard = 0;
  int heard_twice = 0;
  bus->Subscribe("A", [&](auto message) { heard += message.empty() ? 0 : 1; });
  same->Subscribe("B", [&](auto message) { heard_twice += message.size() == 1 ? 1 : 0; });
  bus->Publish("A", Bytes("m"));
  same->Publish("B", Bytes("m"));  // one tag within the other
  while (bus->Poll(0) > 0) {
  }
  EXPECT_EQ(heard, 1);
  EXPECT_EQ(heard_twice, 1);
  EXPECT_EQ(bus->refused_messages() + same->refused_messages(), 0);
  EXPECT_THROW(OpenBus("memq://", {.key_file = folder_.path() / "none"}), Error);
}

}  // namespace
}  // namespace fresco
