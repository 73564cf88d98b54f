// What /proc says about processes that this test starts itself.
#include "soak/process_watch.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "core/child_process.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

TEST(ReadProcess, CountsDescriptorsAndMemory) {
  const auto before = ReadProcess(getpid());
  ASSERT_TRUE(before);
  EXPECT_EQ(before->program, "soak_test");
  EXPECT_EQ(before->parent, getppid());
  const int descriptors[] = {open("/dev/null", O_RDONLY), open("/dev/null", O_RDONLY)};
  const std::vector<char> memory(64 << 20, 'x');
  const auto after = ReadProcess(getpid());
  for (const int descriptor : descriptors) {
    close(descriptor);
  }
  EXPECT_EQ(after->use.descriptors, before->use.descriptors + 2);
  EXPECT_GT(after->use.resident_kib, before->use.resident_kib + 60 * 1024);
  EXPECT_GE(after->use.peak_kib, after->use.resident_kib);
  EXPECT_EQ(memory.back(), 'x');
}

TEST(ReadProcess, FindsNoProcessWhereThereIsNone) {
  EXPECT_FALSE(ReadProcess(999'999'999));
}

TEST(ProcessesLeftBehind, AreChildrenThatHaveNotEnded) {
  const TemporaryFolder folder;  // no other program's: learners at work below it would count
  EXPECT_TRUE(ProcessesLeftBehind(folder.path()).empty());
  ChildProcess child({"/bin/sleep", "600"}, folder.path() / "process_watch_test.log");
  const auto found = ProcessesLeftBehind(folder.path());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find(std::to_string(child.pid())), std::string::npos) << found[0];
  child.End(10'000'000);
  EXPECT_TRUE(ProcessesLeftBehind(folder.path()).empty());
}

TEST(FilesLeftBehind, AreHalfWrittenOnes) {
  const TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  std::filesystem::create_directory(folder / "inner");
  std::ofstream(folder / "whole.network") << "x";
  EXPECT_TRUE(FilesLeftBehind(folder).empty());
  std::ofstream(folder / "inner" / "half.network.tmp12") << "x";
  const auto found = FilesLeftBehind(folder);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find("inner/half.network.tmp12"), std::string::npos);
}

TEST(Include, TakesTheMostOfEveryFigure) {
  UseByProgram maxima = {{"a", {10, 20, 3}}};
  Include({{"a", {5, 25, 2}}, {"b", {1, 2, 3}}}, maxima);
  EXPECT_EQ(maxima.at("a").resident_kib, 10);
  EXPECT_EQ(maxima.at("a").peak_kib, 25);
  EXPECT_EQ(maxima.at("a").descriptors, 3);
  EXPECT_EQ(maxima.at("b").peak_kib, 2);
}

}  // namespace
}  // namespace fresco
