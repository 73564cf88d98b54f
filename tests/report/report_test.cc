#include "report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "report/drawings.h"
#include "tests/report/picture_files.h"
#include "tests/worlds/test_scenarios.h"
#include "tests/worlds/walk_world.h"
#include "worlds/uav/baselines.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Like a plot of gnuplot: a symbol with an id, and a reference to it.
const char kPlot[] =
    "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
    "<svg viewBox=\"0 0 10 10\" xmlns=\"http://www.w3.org/2000/svg\" "
    "xmlns:xlink=\"http://www.w3.org/1999/xlink\">"
    "<defs><circle id='gpDot' r='1'/></defs><use xlink:href='#gpDot'/></svg>\n";

/// Returns the first group of every match of the pattern.
std::vector<std::string> Matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match) {
    found.push_back((*match)[1]);
  }
  return found;
}

/// Returns what a browser takes for the data: the text up to the next end tag of a script.
std::string FlightData(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"flight-data\">";
  const size_t from = page.find(begin) + begin.size();
  return page.substr(from, page.find("</script", from) - from);
}

std::string Decoded(const std::string& encoded) {
  std::string text;
  for (size_t at = 0; at < encoded.size(); ++at) {
    if (encoded[at] == '%') {
      text += static_cast<char>(std::stoi(encoded.substr(at + 1, 2), nullptr, 16));
      at += 2;
    } else {
      text += encoded[at];
    }
  }
  return text;
}

std::vector<std::string> FigureDocuments(const std::string& page) {
  std::vector<std::string> documents;
  for (const std::string& encoded : Matches(page, "src=\"data:image/svg\\+xml,([^\"]*)\"")) {
    documents.push_back(Decoded(encoded));
  }
  return documents;
}

class ReportTest : public testing::Test {
 protected:
  ReportContents Everything() {
    ReportContents contents;
    contents.title = "A run";
    contents.summary = "What came out of it.";
    contents.tables = {{"Results", {"flight", "total AoI"}, {{"DQN", "2799"}, {"AoI-based", "3684"}}}};
    contents.figures = {{"Learning", "Loss by update.", kPlot}, {"Gap", "", kPlot}};
    contents.episodes = {{"AoI-based", FlyBaseline(world_, BaselineKind::kAoi)},
                         {"distance-based", FlyBaseline(world_, BaselineKind::kDistance)}};
    contents.world = &world_;
    contents.configuration = "scenario {\n  slots: 70\n}\n";
    return contents;
  }

  const UavWorld world_{TableOneScenario()};
};

TEST_F(ReportTest, ShowsWhatItIsGiven) {
  const std::string page = ReportPage(Everything());
  EXPECT_THAT(page, HasSubstr("<title>A run</title>"));
  EXPECT_THAT(page, HasSubstr("<h1>A run</h1>"));
  EXPECT_THAT(page, HasSubstr("What came out of it."));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">DQN</th><td class=\"number\">2799</td>"));
  EXPECT_THAT(page, HasSubstr("<img alt=\"Learning\""));
  EXPECT_THAT(page, HasSubstr("<p>Loss by update.</p>"));
  EXPECT_THAT(page, HasSubstr("scenario {\n  slots: 70\n}\n"));
  EXPECT_THAT(Matches(page, "<a href=\"#([a-z]+)\""),
              ElementsAre("numbers", "figures", "flights", "configuration"));
  EXPECT_THAT(Matches(page, "<section id=\"([a-z]+)\""),
              ElementsAre("numbers", "figures", "flights", "configuration"));
}

TEST_F(ReportTest, LeavesOutWhatIsEmpty) {
  ReportContents contents;
  contents.title = "Nothing yet";
  const std::string page = ReportPage(contents);
  EXPECT_THAT(page, Not(HasSubstr("<section")));
  EXPECT_THAT(page, Not(HasSubstr("<nav")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"flight-data\"")));
}

/// A plug-in may have any name.
TEST_F(ReportTest, DrawsNoEpisodesOfAnotherWorldWhateverItsName) {
  WorldDescription description = WalkWorld::Description();
  description.name = world_.description().name;
  const WalkWorld walk(description);
  EXPECT_EQ(DrawingOf(walk), nullptr);
  ASSERT_NE(DrawingOf(world_), nullptr);
  EXPECT_EQ(DrawingOf(world_)->id, "flights");
  ReportContents contents = Everything();
  contents.world = &walk;
  const std::string page = ReportPage(contents);
  EXPECT_THAT(Matches(page, "<section id=\"([a-z]+)\""), ElementsAre("numbers", "figures", "configuration"));
  EXPECT_THAT(page, Not(HasSubstr("FlightPlayer")));
}

TEST_F(ReportTest, SaysWhatAoiIsOnlyInTheUavsWorld) {
  EXPECT_THAT(ReportPage(Everything()), HasSubstr("AoI is age of information"));
  ReportContents contents;
  contents.title = "CartPole";
  EXPECT_THAT(ReportPage(contents), Not(HasSubstr("AoI is")));
}

TEST_F(ReportTest, CarriesTheWorld) {
  const Json world = Json::parse(FlightData(ReportPage(Everything())))["world"];
  EXPECT_EQ(world, Json::parse(R"({"columns": 20, "rows": 20, "cell_m": 25.0, "slots": 70,
      "start": {"column": 10, "row": 0}, "stop": {"column": 10, "row": 19}, "coverage_radius_m": 100.0,
      "sensors": [{"x_m": 200.0, "y_m": 175.0, "weight": 1.0}, {"x_m": 25.0, "y_m": 100.0, "weight": 1.0},
                  {"x_m": 450.0, "y_m": 475.0, "weight": 1.0}]})"));
}

TEST_F(ReportTest, CarriesEverySlotOfEveryFlight) {
  const ReportContents contents = Everything();
  const Json flights = Json::parse(FlightData(ReportPage(contents)))["flights"];
  ASSERT_EQ(flights.size(), 2);
  for (size_t number = 0; number < 2; ++number) {
    const ReportEpisode& expected = contents.episodes[number];
    EXPECT_EQ(flights[number]["policy"], expected.name);
    EXPECT_EQ(flights[number]["outcome"], "arrived");
    ASSERT_EQ(flights[number]["flight"].size(), 70);
    for (size_t slot = 0; slot < 70; ++slot) {
      const UavState state = StateIn(expected.episode, slot);
      const Action action = ActionIn(world_, expected.episode, slot);
      const Json& found = flights[number]["flight"][slot];
      EXPECT_EQ(found["slot"], slot + 1);
      EXPECT_EQ(found["column"], state.cell.column);
      EXPECT_EQ(found["row"], state.cell.row);
      EXPECT_EQ(found["move"], MoveName(action.move));
      EXPECT_EQ(found["scheduled"], action.schedule);
      EXPECT_EQ(found["aoi"].get<std::vector<int16_t>>(), state.aoi);
    }
  }
}

// Eq. Dynamic-AoI: exactly the collected data have AoI 1 in the next slot.
TEST_F(ReportTest, SaysWhatIsCollected) {
  const Json data = Json::parse(FlightData(ReportPage(Everything())));
  const Json& slots = data["flights"][0]["flight"];
  int collections = 0;
  for (size_t slot = 0; slot + 1 < slots.size(); ++slot) {
    for (int sensor = 1; sensor <= 3; ++sensor) {
      const bool collected = slots[slot]["collected"] && slots[slot]["scheduled"] == sensor;
      EXPECT_EQ(collected, slots[slot + 1]["aoi"][sensor - 1] == 1) << slot << " " << sensor;
      collections += collected ? 1 : 0;
    }
  }
  EXPECT_GT(collections, 0);
}

TEST_F(ReportTest, ASensorScheduledOutOfCoverageIsNotCollected) {
  ReportContents contents = Everything();
  contents.episodes = {{"in vain", Fly(world_, [](const UavEnvironment&) {
                          return Action{Move::kNorth, 3};  // sensor 3 is 20 cells away at first
                        })}};
  const Json data = Json::parse(FlightData(ReportPage(contents)));
  EXPECT_EQ(data["flights"][0]["flight"][0]["scheduled"], 3);
  EXPECT_EQ(data["flights"][0]["flight"][0]["collected"], false);
}

TEST_F(ReportTest, FiguresWithTheSameIdsAreDocumentsOfTheirOwn) {
  const std::string page = ReportPage(Everything());
  EXPECT_THAT(FigureDocuments(page), ElementsAre(kPlot, kPlot));
  EXPECT_THAT(page, Not(HasSubstr("gpDot'")));
}

TEST_F(ReportTest, EveryIdOfThePageIsThereOnce) {
  const std::vector<std::string> ids = Matches(ReportPage(Everything()), "<[^<>]* id=\"([^\"]*)\"");
  EXPECT_GT(ids.size(), 10);
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
}

TEST_F(ReportTest, StatesAFigureThatIsNone) {
  ReportContents contents = Everything();
  contents.figures = {{"Gap", "", "gnuplot: no such file"}};
  const std::string page = ReportPage(contents);
  EXPECT_THAT(page, HasSubstr("expected an SVG document, found 21 bytes"));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
}

TEST_F(ReportTest, NoTextBecomesMarkup) {
  const std::string harm = "\"'></title></script><script>alert(1)</script><!-- {{script}}";
  const ReportContents harmless = Everything();
  ReportContents contents = harmless;
  contents.title = contents.summary = contents.configuration = harm;
  contents.tables = {{harm, {harm, harm}, {{harm, harm}, {harm, harm}}}};
  contents.figures = {{harm, harm, kPlot + harm}, {harm, "", kPlot}};
  contents.episodes[0].name = contents.episodes[1].name = harm;
  const std::string page = ReportPage(contents);
  for (const char* markup : {"<script", "</script", "<!--", "</title"}) {
    EXPECT_EQ(Count(page, markup), Count(ReportPage(harmless), markup)) << markup;
  }
  EXPECT_EQ(Json::parse(FlightData(page))["flights"][1]["policy"], harm);
  EXPECT_THAT(page, HasSubstr("<h1>&quot;&#39;&gt;&lt;/title&gt;&lt;/script&gt;&lt;script&gt;alert(1)"));
}

TEST_F(ReportTest, ANameThatIsNoUtf8StillGivesAPage) {
  ReportContents contents = Everything();
  contents.episodes[0].name = "\xff run";
  EXPECT_EQ(Json::parse(FlightData(ReportPage(contents)))["flights"][0]["policy"], "\uFFFD run");
}

TEST_F(ReportTest, RefersToNothingOutsideItself) {
  const std::string page = ReportPage(Everything());
  for (const std::string& address : Matches(page, "\\b(https?://[^\"' ]*)")) {
    EXPECT_EQ(address, "http://www.w3.org/2000/svg");  // the name of a namespace; nobody opens it
  }
  const std::vector<std::string> references =
      Matches(page, "<[a-z][^<>]*\\s(?:src|href|srcset|action|data|poster)=\"([^\"]{0,5})");
  EXPECT_GE(references.size(), 7);
  for (const std::string& reference : references) {
    EXPECT_TRUE(reference.starts_with("#") || reference == "data:") << reference;
  }
  for (const char* loading :
       {"@import", "fetch(", "XMLHttpRequest", "import(", "WebSocket", "<link rel=\"style"}) {
    EXPECT_THAT(page, Not(HasSubstr(loading)));
  }
  for (const std::string& url : Matches(page, "url\\(([^)]*)\\)")) {
    EXPECT_TRUE(url.starts_with("#")) << url;
  }
  EXPECT_THAT(page, HasSubstr("default-src 'none'; img-src data:;"));
}

TEST_F(ReportTest, NumbersStandAtTheRightWhereAColumnHasNothingElse) {
  ReportContents contents;
  contents.tables = {{"", {"a", "b", "c", "d"}, {{"x", "-1.5 %", "yes", "−3"}, {"y", "–", "2", ""}}}};
  const std::string page = ReportPage(contents);
  EXPECT_THAT(page, HasSubstr("<tr><th scope=\"col\">a</th><th scope=\"col\" class=\"number\">b</th>"
                              "<th scope=\"col\">c</th><th scope=\"col\" class=\"number\">d</th></tr>"));
  EXPECT_THAT(page, HasSubstr("<tr><th scope=\"row\">y</th><td class=\"number\">–</td><td>2</td>"
                              "<td class=\"number\"></td></tr>"));
}

TEST_F(ReportTest, ATableWithoutAHeaderIsAListOfValues) {
  ReportContents contents;
  contents.tables = {{"Run", {}, {{"seed", "7"}, {"updates", "12000"}}}};
  const std::string page = ReportPage(contents);
  EXPECT_THAT(page, Not(HasSubstr("<thead>")));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">seed</th><td class=\"number\">7</td>"));
}

using ReportDeathTest = ReportTest;

TEST_F(ReportDeathTest, RowsOfDifferentLengthsAreAProgrammersError) {
  ReportContents contents;
  contents.tables = {{"", {"a", "b"}, {{"1"}}}};
  EXPECT_DEATH(ReportPage(contents), "row.size");
}

TEST_F(ReportDeathTest, FlightsWithoutAWorldAreAProgrammersError) {
  ReportContents contents = Everything();
  contents.world = nullptr;
  EXPECT_DEATH(ReportPage(contents), "world != nullptr");
}

}  // namespace
}  // namespace fresco
