#include "core/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/atomic_file.h"
#include "core/error.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;
using testing::AllOf;
using testing::HasSubstr;

class OutputFolderTest : public ::testing::Test {
 protected:
  OutputFolderTest()
      : directory_(std::filesystem::temp_directory_path() / ("fresco-output-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(directory_);
  }
  ~OutputFolderTest() override {
    std::filesystem::permissions(directory_, std::filesystem::perms::owner_all);
    std::filesystem::remove_all(directory_);
  }

  static std::string Refusal(const Path& folder) {
    try {
      CheckOutputFolder(folder, "--folder");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      return error.what();
    }
    return "accepted";
  }

  Path directory_;
};

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

}  // namespace
}  // namespace fresco
