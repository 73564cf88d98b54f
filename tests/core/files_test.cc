// Files and folders, and the tables in CSV files.
#include "core/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>

#include "core/csv.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;
using testing::AllOf;
using testing::HasSubstr;

class FilesTest : public ::testing::Test {
 protected:
  ~FilesTest() override { std::filesystem::permissions(directory_, std::filesystem::perms::owner_all); }

  const TemporaryFolder folder_;
  const Path& directory_ = folder_.path();
};

class AtomicFile : public FilesTest {};
class FolderLockTest : public FilesTest {};
class OutputFolderTest : public FilesTest {};

std::string RefusalOf(const Path& folder) {
  return ErrorOf([&] { CheckOutputFolder(folder, "--folder"); });
}

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
  EXPECT_THAT(ErrorOf([&] { ReadFile(missing); }), HasSubstr(directory_.string()));
  EXPECT_THAT(ErrorOf([&] { ReadFile(directory_); }), HasSubstr(directory_.string()));
  EXPECT_THAT(ErrorOf([&] { WriteFileAtomically(missing, "x"); }, ErrorKind::kFailure),
              HasSubstr(directory_.string()));
}

TEST_F(OutputFolderTest, IsThereOrCanBeMadeAndIsNotMadeByTheCheck) {
  EXPECT_NO_THROW(CheckOutputFolder(directory_, "--folder"));
  EXPECT_NO_THROW(CheckOutputFolder(directory_ / "a" / "b" / "", "--folder"));
  EXPECT_NO_THROW(CheckOutputFolder(std::filesystem::relative(directory_ / "a"), "--folder"));
  EXPECT_TRUE(std::filesystem::is_empty(directory_));
}

TEST_F(OutputFolderTest, CanNotBeBelowAFile) {
  WriteFileAtomically(directory_ / "file", "not a folder");
  for (const Path& folder : {directory_ / "file", directory_ / "file" / "run"}) {
    EXPECT_THAT(RefusalOf(folder), AllOf(HasSubstr("--folder"), HasSubstr(folder.string()),
                                         HasSubstr((directory_ / "file").string() + " is not a folder")));
  }
}

TEST_F(OutputFolderTest, IsRefusedWhereThisUserMayNotWrite) {
  if (geteuid() == 0) {
    GTEST_SKIP() << "root may write everywhere";
  }
  std::filesystem::permissions(directory_, std::filesystem::perms::owner_read);
  for (const Path& folder : {directory_, directory_ / "run"}) {
    EXPECT_THAT(RefusalOf(folder), AllOf(HasSubstr(folder.string()), HasSubstr("Permission denied")));
  }
}

TEST_F(FolderLockTest, LetsOneInAtATime) {
  std::optional<FolderLock> first(directory_);
  EXPECT_THAT(ErrorOf([&] { FolderLock{directory_}; }), HasSubstr(directory_.string()));
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

TEST(Csv, QuotesOnlyWhatHasToBeQuoted) {
  // RFC 4180, section 2, rules 5 to 7.
  EXPECT_EQ(CsvText({"policy", "note"}, {{"DQN", "plain text"}, {"a,b", "say \"no\""}, {"two\nlines", ""}}),
            "policy,note\nDQN,plain text\n\"a,b\",\"say \"\"no\"\"\"\n\"two\nlines\",\n");
}

TEST(Csv, KeepsEveryBitOfANumber) {
  const double awkward[] = {0.1 + 0.2, 1.0 / 3, 13.280952380952381, -2.5e-300, 6.02214076e23};
  for (const double value : awkward) {
    const std::string text = CsvText({"value"}, {{value}});
    EXPECT_EQ(std::strtod(text.c_str() + sizeof("value"), nullptr), value) << text;
  }
  EXPECT_EQ(CsvText({"count", "value"}, {{int64_t{9007199254740993}, 0.5}}),
            "count,value\n9007199254740993,0.5\n");
}

TEST(Csv, WritesTheFile) {
  const TemporaryFolder folder;
  WriteCsv(folder.path() / "table.csv", {"radius"}, {{1}, {2.5}});
  EXPECT_EQ(ReadFile(folder.path() / "table.csv"), "radius\n1\n2.5\n");
}

TEST(CsvDeathTest, RefusesARowOfAnotherLength) {
  EXPECT_DEATH(CsvText({"a", "b"}, {{1}}), "header");
}

}  // namespace
}  // namespace fresco
