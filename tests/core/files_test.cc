#include "core/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <optional>

#include "core/error.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;
using testing::AllOf;
using testing::HasSubstr;

class FilesTest : public ::testing::Test {
 protected:
  FilesTest()
      : directory_(std::filesystem::temp_directory_path() / ("fresco-files-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(directory_);
  }
  ~FilesTest() override {
    std::filesystem::permissions(directory_, std::filesystem::perms::owner_all);
    std::filesystem::remove_all(directory_);
  }

  Path directory_;
};

class AtomicFile : public FilesTest {};
class FolderLockTest : public FilesTest {};

class OutputFolderTest : public FilesTest {
 protected:
  static std::string Refusal(const Path& folder) {
    try {
      CheckOutputFolder(folder, "--folder");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      return error.what();
    }
    return "accepted";
  }
};

TEST_F(AtomicFile, ReadsBackWhatWasWritten) {
  const std::string content("a\0b\n", 4);
  WriteFileAtomically(directory_ / "file", content);
  EXPECT_EQ(ReadFile(directory_ / "file"), content);
  WriteFileAtomically(directory_ / "file", "");
  EXPECT_EQ(ReadFile(directory_ / "file"), "");
}

TEST_F(AtomicFile, LeavesNothingButTheFile) {
  WriteFileAtomically(directory_ / "file", "content");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_), {}), 1);
}

TEST_F(AtomicFile, LeavesWhatWasThereWhereTheLastStepFails) {
  // A rename over a directory fails after the temporary file was written.
  std::filesystem::create_directories(directory_ / "taken" / "below");
  EXPECT_THROW(WriteFileAtomically(directory_ / "taken", "new"), Error);
  EXPECT_TRUE(std::filesystem::is_directory(directory_ / "taken"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_), {}), 1);
}

TEST_F(AtomicFile, NamesThePathThatCannotBeReadOrWritten) {
  const auto missing = directory_ / "absent" / "file";
  for (const auto& call : {std::function<void()>([&] { ReadFile(missing); }),
                           std::function<void()>([&] { WriteFileAtomically(missing, "x"); }),
                           std::function<void()>([&] { ReadFile(directory_); })}) {
    try {
      call();
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(directory_.string()), std::string::npos) << error.what();
    }
  }
}

TEST_F(OutputFolderTest, IsThereOrCanBeMadeAndIsNotMadeByTheCheck) {
  EXPECT_EQ(Refusal(directory_), "accepted");
  EXPECT_EQ(Refusal(directory_ / "a" / "b" / ""), "accepted");
  EXPECT_EQ(Refusal(std::filesystem::relative(directory_ / "a")), "accepted");
  EXPECT_TRUE(std::filesystem::is_empty(directory_));
}

TEST_F(OutputFolderTest, CanNotBeBelowAFile) {
  WriteFileAtomically(directory_ / "file", "not a folder");
  for (const Path& folder : {directory_ / "file", directory_ / "file" / "run"}) {
    EXPECT_THAT(Refusal(folder), AllOf(HasSubstr("--folder"), HasSubstr(folder.string()),
                                       HasSubstr((directory_ / "file").string() + " is not a folder")));
  }
}

TEST_F(OutputFolderTest, IsRefusedWhereThisUserMayNotWrite) {
  if (geteuid() == 0) {
    GTEST_SKIP() << "root may write everywhere";
  }
  std::filesystem::permissions(directory_, std::filesystem::perms::owner_read);
  for (const Path& folder : {directory_, directory_ / "run"}) {
    EXPECT_THAT(Refusal(folder), AllOf(HasSubstr(folder.string()), HasSubstr("Permission denied")));
  }
}

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
