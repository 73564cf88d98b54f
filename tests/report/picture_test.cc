#include "report/picture.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "report/gnuplot.h"
#include "tests/report/picture_files.h"

namespace fresco {
namespace {

Picture SmallPicture() {
  return {400, 250, "set title 'small'\nplot [0:1] x\n"};
}

TEST(Picture, IsAnSvgAndAPngOfTwiceTheSize) {
  const TemporaryFolder folder("picture");
  WritePicture(SmallPicture(), folder.path() / "effect.of.R");
  EXPECT_EQ(folder.files(), 2);
  EXPECT_TRUE(ParsesAsXml(folder.path() / "effect.of.R.svg"));
  EXPECT_NE(ReadFile(folder.path() / "effect.of.R.svg").find("width=\"400\" height=\"250\""),
            std::string::npos);
  EXPECT_EQ(PngSize(ReadFile(folder.path() / "effect.of.R.png")), std::pair(800U, 500U));
}

TEST(Picture, IsTheSameBytesEveryTime) {
  const TemporaryFolder folder("picture");
  WritePicture(SmallPicture(), folder.path() / "one");
  WritePicture(SmallPicture(), folder.path() / "two");
  EXPECT_EQ(ReadFile(folder.path() / "one.svg"), ReadFile(folder.path() / "two.svg"));
  EXPECT_EQ(ReadFile(folder.path() / "one.png"), ReadFile(folder.path() / "two.png"));
}

TEST(Picture, LeavesNothingWhereItFails) {
  const TemporaryFolder folder("picture");
  Picture picture = SmallPicture();
  picture.script += "plot [0:1] no_such_function(x)\n";  // after a whole picture has been drawn
  EXPECT_THROW(WritePicture(picture, folder.path() / "figure"), Error);
  EXPECT_EQ(folder.files(), 0);
}

TEST(Picture, LeavesTheOldOneWhereTheNewOneFails) {
  const TemporaryFolder folder("picture");
  WritePicture(SmallPicture(), folder.path() / "figure");
  const std::string before = ReadFile(folder.path() / "figure.svg");
  EXPECT_THROW(WritePicture({400, 250, "nonsense\n"}, folder.path() / "figure"), Error);
  EXPECT_EQ(ReadFile(folder.path() / "figure.svg"), before);
}

TEST(Picture, RefusesToBeNothing) {
  const TemporaryFolder folder("picture");
  EXPECT_THROW(WritePicture({400, 250, "x = 1\n"}, folder.path() / "figure"), Error);
  EXPECT_EQ(folder.files(), 0);
}

TEST(Picture, ShowsHostileTextAsItIs) {
  const TemporaryFolder folder("picture");
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
