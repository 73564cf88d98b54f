// Runs gnuplot, and checks the pictures that it draws.
#include "report/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/files.h"
#include "tests/report/picture_files.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Sets PATH to a folder until its end.
class PathGuard {
 public:
  explicit PathGuard(const std::filesystem::path& path) : before_(std::getenv("PATH")) {
    setenv("PATH", path.c_str(), 1);
  }
  ~PathGuard() { setenv("PATH", before_.c_str(), 1); }
  PathGuard(const PathGuard&) = delete;
  PathGuard& operator=(const PathGuard&) = delete;

 private:
  std::string before_;
};

std::string FailureOf(const std::string& script, int64_t timeout_us = kGnuplotTimeoutUs) {
  return ErrorOf([&] { RunGnuplot(script, timeout_us); }, ErrorKind::kFailure);
}

void WriteProgram(const std::filesystem::path& path, const std::string& script) {
  WriteFileAtomically(path, "#!/bin/sh\n" + script);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
}

TEST(Gnuplot, GivesWhatTheScriptPrints) {
  EXPECT_EQ(RunGnuplot("set print '-'\nprint 6 * 7\n"), "42\n");
  EXPECT_EQ(RunGnuplot(""), "");
}

TEST(Gnuplot, TakesAndGivesMoreThanAPipeHolds) {
  std::string script = "set print '-'\n";
  std::string expected;
  for (int i = 0; i < 4000; ++i) {
    const std::string line = std::to_string(i) + std::string(100, '.');
    script += "print '" + line + "'\n";
    expected += line + "\n";
  }
  EXPECT_EQ(RunGnuplot(script), expected);
}

TEST(Gnuplot, FailsInItsOwnWordsOnABrokenScript) {
  EXPECT_THAT(FailureOf("set title 'fine'\nset nonsense\n"),
              AllOf(HasSubstr("set nonsense"), HasSubstr("exit status")));
}

TEST(Gnuplot, NamesThePackageOfAMissingProgram) {
  const TemporaryFolder empty;
  const PathGuard path(empty.path());
  EXPECT_THAT(FailureOf("print 1\n"), HasSubstr("gnuplot-nox"));
}

TEST(Gnuplot, SurvivesAProgramThatReadsNothing) {
  const TemporaryFolder folder;
  WriteProgram(folder.path() / "gnuplot", "echo no licence >&2\nexit 3\n");
  const PathGuard path(folder.path());
  EXPECT_THAT(FailureOf(std::string(1 << 20, '\n')),
              AllOf(HasSubstr("exit status 3"), HasSubstr("no licence")));
}

TEST(Gnuplot, TellsOfASignal) {
  const TemporaryFolder folder;
  WriteProgram(folder.path() / "gnuplot", "kill -9 $$\n");
  const PathGuard path(folder.path());
  EXPECT_THAT(FailureOf(""), HasSubstr("signal 9"));
}

TEST(Gnuplot, EndsAScriptThatDoesNotEnd) {
  EXPECT_THAT(FailureOf("while (1) { x = 1 }\n", 20'000), HasSubstr("did not finish within 20 ms"));
}

TEST(Gnuplot, HasNoUseForTheUsersSettings) {
  const TemporaryFolder home;
  WriteFileAtomically(home.path() / ".gnuplot", "x = 'of the user'\n");
  const std::string before = std::getenv("HOME") == nullptr ? "" : std::getenv("HOME");
  setenv("HOME", home.path().c_str(), 1);
  EXPECT_EQ(RunGnuplot("set print '-'\nprint exists('x')\n"), "0\n");
  setenv("HOME", before.c_str(), 1);
}

TEST(GnuplotString, BringsEveryTextBackAsItIs) {
  for (const std::string text : {"plain", "'it's'", "\"", "\\", "`", "a\\", "''", "back\\slash\\n",
                                 "a `date` b", "$x @y #z \"q\"", "{/Bold x}_1^2 %d", "Δ é 漢 😀", ""}) {
    EXPECT_EQ(RunGnuplot("set print '-'\nprint " + GnuplotString(text) + "\n"), text + "\n");
  }
}

TEST(GnuplotString, ReplacesWhatAPictureCannotShow) {
  EXPECT_EQ(GnuplotString("two\nlines\tand\x7F more"), "\"two lines and  more\"");
  EXPECT_EQ(GnuplotString(std::string("a\0b", 3)), "\"a b\"");
  EXPECT_EQ(GnuplotString("]]>"), "\"]] >\"");
  const char* const kReplacement = "\xEF\xBF\xBD";
  // Alone, cut short, overlong, a surrogate, beyond U+10FFFF, U+FFFE.
  for (const std::string bytes : {"\x80", "\xC3", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80",
                                  "\xF4\x90\x80\x80", "\xF0\x80\x80\x80", "\xEF\xBF\xBE", "\xFF"}) {
    std::string expected;
    for (size_t i = 0; i < bytes.size(); ++i) {
      expected += kReplacement;
    }
    EXPECT_EQ(GnuplotString(bytes), "\"" + expected + "\"");
  }
}

Picture SmallPicture() {
  return {400, 250, "set title 'small'\nplot [0:1] x\n"};
}

TEST(Picture, IsAnSvgAndAPngOfTwiceTheSize) {
  const TemporaryFolder folder;
  WritePicture(SmallPicture(), folder.path() / "effect.of.R");
  EXPECT_EQ(FileCount(folder.path()), 2);
  EXPECT_TRUE(ParsesAsXml(folder.path() / "effect.of.R.svg"));
  EXPECT_THAT(ReadFile(folder.path() / "effect.of.R.svg"), HasSubstr("width=\"400\" height=\"250\""));
  EXPECT_EQ(PngSize(ReadFile(folder.path() / "effect.of.R.png")), std::pair(800U, 500U));
}

TEST(Picture, IsTheSameBytesEveryTime) {
  const TemporaryFolder folder;
  WritePicture(SmallPicture(), folder.path() / "one");
  WritePicture(SmallPicture(), folder.path() / "two");
  EXPECT_EQ(ReadFile(folder.path() / "one.svg"), ReadFile(folder.path() / "two.svg"));
  EXPECT_EQ(ReadFile(folder.path() / "one.png"), ReadFile(folder.path() / "two.png"));
}

TEST(Picture, LeavesNothingWhereItFails) {
  const TemporaryFolder folder;
  Picture picture = SmallPicture();
  picture.script += "plot [0:1] no_such_function(x)\n";  // after a whole picture has been drawn
  EXPECT_THROW(WritePicture(picture, folder.path() / "figure"), Error);
  EXPECT_EQ(FileCount(folder.path()), 0);
}

TEST(Picture, LeavesTheOldOneWhereTheNewOneFails) {
  const TemporaryFolder folder;
  WritePicture(SmallPicture(), folder.path() / "figure");
  const std::string before = ReadFile(folder.path() / "figure.svg");
  EXPECT_THROW(WritePicture({400, 250, "nonsense\n"}, folder.path() / "figure"), Error);
  EXPECT_EQ(ReadFile(folder.path() / "figure.svg"), before);
}

TEST(Picture, RefusesToBeNothing) {
  const TemporaryFolder folder;
  EXPECT_THROW(WritePicture({400, 250, "x = 1\n"}, folder.path() / "figure"), Error);
  EXPECT_EQ(FileCount(folder.path()), 0);
}

TEST(Picture, ShowsHostileTextAsItIs) {
  const TemporaryFolder folder;
  const std::string text = "it's \"x\" \\ {a}_b^c @m `date` $x %d &amp; <tag> \xC3\xA9 \xCE\x94";
  const std::string shown = "it's \"x\" \\ {a}_b^c @m `date` $x %d &amp;amp; &lt;tag> \xC3\xA9 \xCE\x94";
  const std::string unshowable = "a\nb\x01]]>\xFF";
  Picture picture{800, 400, ""};
  const Legend legend({{text, "linecolor rgb '#000000'", "linewidth 1", "pointtype 7"}}, picture.width_px);
  picture.script = FrameScript({.title = text, .x_label = text, .y_label = text, .right_label = unshowable},
                               picture, legend) +
                   "plot [0:1] x\n";
  WritePicture(picture, folder.path() / "hostile");
  EXPECT_TRUE(ParsesAsXml(folder.path() / "hostile.svg"));
  const std::string svg = ReadFile(folder.path() / "hostile.svg");
  EXPECT_EQ(Count(svg, shown), 4) << svg;
  EXPECT_EQ(Count(svg, "a b ]] >\xEF\xBF\xBD"), 1) << svg;
}

TEST(Legend, TakesAsManyRowsAsItsNamesNeed) {
  const LegendEntry entry{"a name of some length", "linecolor rgb '#000000'", "linewidth 1", ""};
  const int one_row_px = Legend({entry}, 800).height_px();
  EXPECT_EQ(Legend({}, 800).height_px(), 0);
  EXPECT_EQ(Legend({entry, entry, entry}, 800).height_px(), one_row_px);
  EXPECT_GT(Legend({entry, entry, entry, entry, entry}, 800).height_px(), one_row_px);
}

}  // namespace
}  // namespace fresco
