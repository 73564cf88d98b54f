// Rows: chosen, measured, printed and checked.
#include "tests/bench/rows.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/error_of.h"

namespace fresco {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<Subject> Subjects(std::vector<double>* seconds = nullptr) {
  const auto note = [seconds](double s) {
    if (seconds != nullptr) {
      seconds->push_back(s);
    }
  };
  return {{{"fast", "slow"},
           [=](double s) {
             note(s);
             return Results{{MoreIsBetter("fast", 30, "m/s", "a horse", 15),
                             LessIsBetter("slow", 30, "ms", "light", 15)},
                            {}};
           }},
          {{"missing"}, [=](double s) {
             note(s);
             return AllAbsent({"missing"}, "not installed");
           }}};
}

Results Measured(const std::vector<std::string>& names) {
  return MeasureRows(Subjects(), names, 1, [](const std::string&, size_t, size_t) {});
}

BenchHead SomeHead() {
  return {"a processor", 2, "x86-64-v3", "gcc 12 -O3", "abc1234"};
}

TEST(Rows, HaveARatioThatIsLargerTheBetter) {
  EXPECT_EQ(MoreIsBetter("a", 30, "m/s", "", 15).ratio, 2);
  EXPECT_EQ(LessIsBetter("a", 30, "ms", "", 15).ratio, 0.5);
}

TEST(Rows, AreSelectedByAPartOfTheirName) {
  EXPECT_THAT(SelectRows(Subjects(), ".*"), ElementsAre("fast", "slow", "missing"));
  EXPECT_THAT(SelectRows(Subjects(), "^s|ast"), ElementsAre("fast", "slow"));
}

TEST(Rows, AreNamedIfTheFilterMatchesNone) {
  EXPECT_THAT(ErrorOf([] { SelectRows(Subjects(), "quick"); }),
              HasSubstr("--filter: no row's name matches \"quick\"; the rows are fast, slow, missing"));
  EXPECT_THAT(ErrorOf([] { SelectRows(Subjects(), "("); }),
              HasSubstr("expected a regular expression, found \"(\""));
}

TEST(Rows, OfSubjectsThatAreNotAskedForAreNotMeasured) {
  std::vector<double> seconds;
  std::vector<std::string> progress;
  const Results results =
      MeasureRows(Subjects(&seconds), {"slow"}, 0.25, [&](const std::string& rows, size_t done, size_t all) {
        progress.push_back(fmt::format("{}, {} of {}", rows, done, all));
      });
  EXPECT_THAT(seconds, ElementsAre(0.25));
  EXPECT_THAT(progress, ElementsAre("slow, 0 of 1"));
  ASSERT_EQ(results.rows.size(), 1u);
  EXPECT_EQ(results.rows[0].name, "slow");
  EXPECT_THAT(results.absent, IsEmpty());
}

TEST(Rows, AreAnObjectInJson) {
  const auto json = nlohmann::json::parse(BenchJson(SomeHead(), Measured({"fast", "missing"})));
  EXPECT_EQ(json, nlohmann::json::parse(R"({
    "machine": {"processor": "a processor", "cores": 2, "arithmetic": "x86-64-v3", "compiler": "gcc 12 -O3"},
    "commit": "abc1234",
    "rows": [{"name": "fast", "value": 30, "unit": "m/s", "reference": "a horse", "reference_value": 15, "ratio": 2}],
    "absent": [{"name": "missing", "reason": "not installed"}]})"));
}

TEST(Rows, AreATableForPeople) {
  EXPECT_EQ(BenchTable(SomeHead(), Measured({"fast", "slow", "missing"})),
            "machine   a processor, 2 cores, x86-64-v3\n"
            "compiler  gcc 12 -O3\n"
            "commit    abc1234\n\n"
            "row        value  unit   reference   ratio  the reference is\n"
            "fast       30.00  m/s        15.00   2.000  a horse\n"
            "slow       30.00  ms         15.00   0.500  light\n"
            "missing  absent: not installed\n");
}

TEST(RecordedRatios, AreReadFromWhatWasPrinted) {
  const RecordedRatios recorded =
      ReadRecordedRatios(BenchJson(SomeHead(), Measured({"slow", "fast"})), "file", Subjects());
  EXPECT_EQ(recorded.processor, "a processor");
  EXPECT_EQ(recorded.arithmetic, "x86-64-v3");
  EXPECT_THAT(recorded.ratios, ElementsAre(testing::Pair("fast", 2.0), testing::Pair("slow", 0.5)));
}

TEST(RecordedRatios, AreRefusedWithTheNameOfTheFile) {
  const auto error = [](const std::string& text) {
    return ErrorOf([&] { ReadRecordedRatios(text, "ratios.json", Subjects()); });
  };
  const auto error_of_row = [&](const std::string& row) {
    return error(R"({"machine": {"processor": "p", "arithmetic": "a"}, "rows": [)" + row + "]}");
  };
  for (const char* text : {"[]", "{", "{}", R"({"machine": {}, "rows": []})",
                           R"({"machine": {"processor": "p", "arithmetic": 1}, "rows": []})",
                           R"({"machine": {"processor": "p", "arithmetic": "a"}, "rows": 1})"}) {
    EXPECT_THAT(error(text), HasSubstr("ratios.json: expected what `fresco bench --format json` prints"));
  }
  EXPECT_THAT(error_of_row("1"), HasSubstr("ratios.json: expected a name"));
  EXPECT_THAT(error_of_row(R"({"name": "fastt", "ratio": 1})"),
              HasSubstr("ratios.json: there is no row \"fastt\"; did you mean fast?"));
  EXPECT_THAT(error_of_row(R"({"name": "fast", "ratio": "2"})"),
              HasSubstr("fast: expected a ratio above 0, found \"2\""));
  EXPECT_THAT(error_of_row(R"({"name": "fast", "ratio": 0})"),
              HasSubstr("fast: expected a ratio above 0, found 0"));
  EXPECT_THAT(error_of_row(R"({"name": "fast"})"), HasSubstr("fast: expected a ratio above 0, found null"));
}

std::vector<std::string> Fallen(std::vector<std::pair<std::string, double>> ratios, const Results& results) {
  std::vector<std::string> lines;
  for (const FallenRow& row : FallenRows({"p", "a", std::move(ratios)}, results)) {
    lines.push_back(row.name + ": " + row.reason);
  }
  return lines;
}

TEST(RecordedRatios, AreFallenFromBelowEightyPercent) {
  const Results results = Measured({"fast", "slow"});
  EXPECT_THAT(Fallen({{"fast", 2.49}, {"slow", 0.62}}, results), IsEmpty());
  EXPECT_THAT(Fallen({{"fast", 2.51}, {"slow", 0.62}}, results),
              ElementsAre("fast: the ratio is 2.000, below 80 % of the recorded 2.510"));
  EXPECT_THAT(Fallen({{"fast", 1}}, Results{{MoreIsBetter("fast", 0, "", "", 0)}, {}}), SizeIs(1));  // 0 / 0
}

TEST(RecordedRatios, AreFallenIfTheirRowIsAbsent) {
  EXPECT_THAT(Fallen({{"missing", 1}}, Measured({"missing"})),
              ElementsAre("missing: absent: not installed; a ratio is recorded"));
}

}  // namespace
}  // namespace fresco
