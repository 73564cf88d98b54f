#include "core/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>

#include "core/error.h"

namespace fresco {
namespace {

class AtomicFile : public ::testing::Test {
 protected:
  AtomicFile()
      : directory_(std::filesystem::temp_directory_path() / ("fresco-atomic-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(directory_);
  }
  ~AtomicFile() override { std::filesystem::remove_all(directory_); }

  std::filesystem::path directory_;
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

}  // namespace
}  // namespace fresco
