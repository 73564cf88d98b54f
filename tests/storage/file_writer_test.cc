#include "storage/file_writer.h"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <condition_variable>

#include "core/error.h"
#include "core/files.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;

class FileWriterTest : public ::testing::Test {
 protected:
  FileWriterTest() { spdlog::set_level(spdlog::level::off); }

  FileWriter::File File(const std::string& name, const std::string& content) const {
    return {name, directory_ / name, [content] { return content; }, {}};
  }
  /// A file whose folder is not there: it can't be written.
  FileWriter::File Impossible(const std::string& name) const {
    return {name, directory_ / "absent" / name, [] { return std::string("late"); }, {}};
  }

  const TemporaryFolder folder_;
  const Path& directory_ = folder_.path();
};

TEST_F(FileWriterTest, WritesEveryFileAndSaysWhenItHas) {
  FileWriter writer;
  int written = 0;
  for (const char* name : {"a", "b", "c"}) {
    FileWriter::File file = File(name, name);
    file.written = [&] { ++written; };
    writer.Write(std::move(file));
  }
  writer.Finish();
  EXPECT_EQ(written, 3);
  EXPECT_EQ(ReadFile(directory_ / "b"), "b");
  EXPECT_FALSE(writer.IsBusy("b"));
  EXPECT_EQ(writer.problem(), "");
}

TEST_F(FileWriterTest, WritesTheLatestContentOnly) {
  std::mutex mutex;
  std::unique_lock hold(mutex);
  FileWriter writer;
  writer.Write({"first", directory_ / "first", [&] { return std::lock_guard(mutex), std::string("1"); }, {}});
  int made = 0;
  for (int i = 0; i < 10; ++i) {  // the writer is held up by the first one
    writer.Write({"second", directory_ / "second", [&made, i] { return ++made, std::to_string(i); }, {}});
  }
  EXPECT_TRUE(writer.IsBusy("first"));
  EXPECT_TRUE(writer.IsBusy("second"));
  hold.unlock();
  writer.Finish();
  EXPECT_EQ(ReadFile(directory_ / "second"), "9");
  EXPECT_EQ(made, 1);
}

TEST_F(FileWriterTest, KeepsWhatCanNotBeWrittenAndWritesTheOthers) {
  FileWriter writer(3'600'000'000);
  writer.Write(Impossible("late"));
  writer.Write(File("other", "o"));
  EXPECT_THROW(writer.Finish(), Error);
  EXPECT_EQ(ReadFile(directory_ / "other"), "o");
  EXPECT_NE(writer.problem().find((directory_ / "absent" / "late").string()), std::string::npos);
  EXPECT_TRUE(writer.IsBusy("late"));
  std::filesystem::create_directories(directory_ / "absent");
  writer.Finish();  // tries at once, not in an hour
  EXPECT_EQ(ReadFile(directory_ / "absent" / "late"), "late");
  EXPECT_EQ(writer.problem(), "");
}

TEST_F(FileWriterTest, TriesAgainByItself) {
  FileWriter writer(1'000);
  std::mutex mutex;
  std::condition_variable changed;
  bool written = false;
  int attempts = 0;
  writer.Write({"late", directory_ / "absent" / "late",
                [&] {
                  if (++attempts == 3) {
                    std::filesystem::create_directories(directory_ / "absent");
                  }
                  return std::string("late");
                },
                [&] {
                  const std::lock_guard lock(mutex);
                  written = true;
                  changed.notify_all();
                }});
  std::unique_lock lock(mutex);
  EXPECT_TRUE(changed.wait_for(lock, std::chrono::seconds(60), [&] { return written; }));
  EXPECT_EQ(attempts, 3);
}

TEST_F(FileWriterTest, WritesWhatWaitsBeforeItEndsAndDropsWhatItCanNot) {
  {
    FileWriter writer(3'600'000'000);
    writer.Write(Impossible("late"));
    writer.Write(File("other", "o"));
  }
  EXPECT_EQ(ReadFile(directory_ / "other"), "o");
}

TEST_F(FileWriterTest, TakesAContentThatCanNotBeMadeForAFileThatCanNotBeWritten) {
  FileWriter writer(3'600'000'000);
  writer.Write({"huge", directory_ / "huge", []() -> std::string { throw Failure("too large"); }, {}});
  EXPECT_THROW(writer.Finish(), Error);
  EXPECT_EQ(writer.problem(), "too large");
  writer.Write(File("huge", "small enough"));
  writer.Finish();
  EXPECT_EQ(writer.problem(), "");
}

}  // namespace
}  // namespace fresco
