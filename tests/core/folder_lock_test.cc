#include "core/folder_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>

#include "core/error.h"

namespace fresco {
namespace {

class FolderLockTest : public ::testing::Test {
 protected:
  FolderLockTest()
      : directory_(std::filesystem::temp_directory_path() / ("fresco-lock-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(directory_);
  }
  ~FolderLockTest() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path directory_;
};

TEST_F(FolderLockTest, LetsOneInAtATime) {
  std::optional<FolderLock> first(directory_);
  try {
    const FolderLock second(directory_);
    FAIL() << "let a second one in";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(directory_.string()), std::string::npos) << error.what();
  }
  first.reset();
  const FolderLock third(directory_);
}

TEST_F(FolderLockTest, EndsWithItsProcessHoweverThatEnds) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const FolderLock lock(directory_);
    static_cast<void>(write(ready[1], "x", 1));
    pause();
    _exit(0);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_THROW(FolderLock{directory_}, Error);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const FolderLock lock(directory_);
  close(ready[0]);
  close(ready[1]);
}

TEST_F(FolderLockTest, NamesAFolderThatIsNotThere) {
  EXPECT_THROW(FolderLock{directory_ / "absent"}, Error);
}

}  // namespace
}  // namespace fresco
