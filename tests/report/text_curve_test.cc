#include "report/text_curve.h"

#include <gtest/gtest.h>

namespace fresco {
namespace {

TEST(TextCurve, DrawsTheBestTheOthersAndTheOptimum) {
  const TextCurve curve{.title = "average AoI [slots]",
                        .points = {{100, 20, 20}, {200, 16, 16}, {300, 18, 16}, {400, 12, 12}},
                        .optimum = 10.0,
                        .columns = 13,
                        .rows = 6};
  EXPECT_EQ(Draw(curve),
            "average AoI [slots]\n"
            "       20 |****         \n"
            "          |        .    \n"
            "          |    ******** \n"
            "          |             \n"
            "          |            *\n"
            "       10 |-------------\n"
            "           100 400 updates\n");
}

TEST(TextCurve, DrawsASinglePoint) {
  const TextCurve curve{.title = "return", .points = {{5, 3, 3}}, .columns = 20, .rows = 2};
  EXPECT_EQ(Draw(curve),
            "return\n"
            "      3.5 |                    \n"
            "      2.5 |********************\n"
            "           5          5 updates\n");
}

TEST(TextCurve, LeavesOutWhatWouldFlattenTheCurve) {
  const TextCurve curve{
      .title = "return", .points = {{1, 10, 10}, {2, -9000, 10}, {3, 20, 20}}, .columns = 3, .rows = 3};
  EXPECT_EQ(Draw(curve),
            "return\n"
            "       20 |  *\n"
            "          |   \n"
            "       10 |** \n"
            "           1 3 updates\n");
}

}  // namespace
}  // namespace fresco
