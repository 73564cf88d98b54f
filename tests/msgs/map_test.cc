// Maps in configurations: pictures of them, what follows from them, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <filesystem>
#include <sstream>

#include "core/files.h"
#include "msgs/experiment.h"
#include "msgs/map_file.h"
#include "tests/msgs/uav_world_of.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"
#include "worlds/uav/uav_fields.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using Pixel = std::array<uint8_t, 4>;  // red, green, blue, opacity

constexpr Pixel kBlack = {0, 0, 0, 255};
constexpr Pixel kWhite = {255, 255, 255, 255};
constexpr Pixel kRed = {255, 0, 0, 255};
constexpr Pixel kGreen = {0, 255, 0, 255};
constexpr Pixel kYellow = {255, 255, 0, 255};
constexpr Pixel kBlue = {0, 0, 255, 255};
constexpr Pixel kTransparent = {0, 0, 0, 0};

const std::filesystem::path kConfigs = std::filesystem::path(FRESCO_SOURCE_DIR) / "configs";

/// Writes a PNG file of so many columns.
void WritePicture(const std::filesystem::path& path, int columns, const std::vector<Pixel>& pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(columns);
  image.height = static_cast<png_uint_32>(pixels.size()) / image.width;
  image.format = PNG_FORMAT_RGBA;
  ASSERT_NE(png_image_write_to_file(&image, path.c_str(), 0, pixels.data(), 0, nullptr), 0) << image.message;
}

/// In a folder of its own, which is the working directory.
class MapTest : public ::testing::Test {
 protected:
  MapTest() { std::filesystem::current_path(folder_.path()); }
  ~MapTest() override { std::filesystem::current_path(before_); }

  const std::filesystem::path before_ = std::filesystem::current_path();
  const TemporaryFolder folder_;
};

TEST_F(MapTest, HasACellForEachPixelOfAPicture) {
  WritePicture("map.png", 4, {kBlack, kRed, kGreen, kYellow, kBlue, kWhite, kTransparent, kBlack});
  EXPECT_THAT(ReadMapFile("map.png"), ElementsAre(".NRB", "S..."));
}

TEST_F(MapTest, OfTheCityIsDrawnFromItsText) {
  std::istringstream text(ReadFile(kConfigs / "city.txt"));
  std::vector<std::string> rows;
  for (std::string row; text >> row;) {
    rows.push_back(row);
  }
  EXPECT_EQ(ReadMapFile(kConfigs / "city.png"), rows);
  EXPECT_EQ(rows.size(), 32u);
}

TEST_F(MapTest, NamesFileAndPixelOfAColourWithoutMeaning) {
  for (const auto& [colour, name] : {std::pair(Pixel{255, 0, 255, 255}, "#ff00ff"),
                                     {Pixel{0, 255, 255, 255}, "#00ffff"},
                                     {Pixel{254, 0, 0, 255}, "#fe0000"},
                                     {Pixel{128, 128, 128, 255}, "#808080"}}) {
    WritePicture("map.png", 3, {kBlack, kBlack, kBlack, kBlack, colour, kBlack});
    EXPECT_THAT(ErrorOf([] { ReadMapFile("map.png"); }),
                AllOf(StartsWith("map.png: the pixel in column 1 from the left and row 1 from the top"),
                      HasSubstr(name), HasSubstr("yellow (both)")));
  }
}

TEST_F(MapTest, RefusesAFileThatIsNoPicture) {
  EXPECT_THAT(ErrorOf([] { ReadMapFile("none.png"); }), HasSubstr("none.png"));
  WriteFileAtomically("text.png", "....\n");
  EXPECT_THAT(ErrorOf([] { ReadMapFile("text.png"); }), StartsWith("text.png: not a PNG file"));
  const std::string city = ReadFile(kConfigs / "city.png");
  WriteFileAtomically("cut.png", city.substr(0, city.size() / 2));
  EXPECT_THAT(ErrorOf([] { ReadMapFile("cut.png"); }), StartsWith("cut.png: a damaged PNG file"));
  WritePicture("large.png", 65, std::vector<Pixel>(65 * 64, kBlack));
  EXPECT_THAT(ErrorOf([] { ReadMapFile("large.png"); }),
              HasSubstr("large.png: 65 x 64 pixels are too many; allowed: a product of at most 4096"));
}

TEST_F(MapTest, IsFoundBesideTheConfigurationOrInTheWorkingDirectory) {
  std::filesystem::create_directory("there");
  WritePicture("there/map.png", 4, {kBlue, kBlack, kBlack, kBlack});
  WriteFileAtomically("there/my.textproto", "scenario { map: \"map.png\" }");
  WritePicture("map.png", 5, {kBlue, kBlack, kBlack, kBlack, kBlack});
  EXPECT_EQ(UavWorldOf(Experiment::Load("there/my.textproto")).scenario().columns, 4);
  std::filesystem::remove("there/map.png");
  EXPECT_EQ(UavWorldOf(Experiment::Load("there/my.textproto")).scenario().columns, 5);
  std::filesystem::remove("map.png");
  EXPECT_THAT(ErrorOf([] { Experiment::Load("there/my.textproto"); }),
              AllOf(StartsWith("there/my.textproto: scenario.map: "), HasSubstr("map.png")));
}

constexpr char kTown[] = R"(scenario {
  map_row: "...SS"
  map_row: ".NB.."
  map_row: "SR..."
})";

TEST_F(MapTest, DecidesColumnsRowsStartAndStop) {
  const Experiment experiment = Experiment::Parse(kTown, "the test");
  const Scenario& scenario = UavWorldOf(experiment).scenario();
  EXPECT_EQ(scenario.columns, 5);
  EXPECT_EQ(scenario.rows, 3);
  EXPECT_EQ(scenario.start, (Cell{0, 0}));
  EXPECT_EQ(scenario.stop, (Cell{4, 2}));
  EXPECT_EQ(experiment.config().scenario().grid().columns(), 5);
  ASSERT_NE(scenario.map, nullptr);
  EXPECT_THAT(scenario.map->Text(), ElementsAre("...SS", ".NB..", "SR..."));
  for (const Sensor& sensor : scenario.sensors) {
    EXPECT_FALSE(scenario.map->BlocksRadio(CellOf(sensor, 25, 5, 3)));
    EXPECT_TRUE(scenario.map->MayFly(CellOf(sensor, 25, 5, 3)));
  }
}

TEST_F(MapTest, TravelsAsTextInTheCompleteConfiguration) {
  WritePicture("map.png", 2, {kBlue, kBlack, kYellow, kBlack, kBlack, kBlue});
  WriteFileAtomically("my.textproto", "scenario { map: \"map.png\" }");
  const Experiment experiment = Experiment::Load("my.textproto");
  EXPECT_THAT(experiment.Text(), AllOf(HasSubstr("map_row: \"S.\"\n  map_row: \"B.\"\n  map_row: \".S\""),
                                       Not(HasSubstr("map.png"))));
  std::filesystem::remove("map.png");
  const Experiment again = Experiment::Parse(experiment.Text(), "the bus");
  EXPECT_EQ(again.Text(), experiment.Text());
  EXPECT_EQ(again.hash(), experiment.hash());
  // Another map is another experiment.
  std::string other = experiment.Text();
  other.replace(other.find("\"B.\""), 4, "\"R.\"");
  EXPECT_NE(Experiment::Parse(other, "the bus").hash(), experiment.hash());
}

// Whoever sends a configuration is not to decide which files are read.
TEST_F(MapTest, IsNotReadForAConfigurationThatIsNoFile) {
  WritePicture("map.png", 4, {kBlue, kBlack, kBlack, kBlack});
  EXPECT_THAT(ErrorOf([] { Experiment::Parse("scenario { map: \"map.png\" }", "the bus"); }),
              AllOf(StartsWith("the bus: scenario.map: \"map.png\""), HasSubstr("scenario.map_row")));
  EXPECT_EQ(UavWorldOf(Experiment::Parse("", "mine", {{"scenario.map", "map.png"}})).scenario().columns, 4);
  EXPECT_THAT(ErrorOf([] {
                Experiment::Parse("scenario { map: \"a\" }", "the bus", {{"scenario.map", "map.png"}});
              }),
              StartsWith("the bus: scenario.map"));
}

TEST_F(MapTest, IsGivenOnceAndFitsTheRest) {
  WritePicture("map.png", 2, {kBlue, kBlack});
  WriteFileAtomically("my.textproto", "scenario { map: \"map.png\" map_row: \"..\" }");
  EXPECT_THAT(ErrorOf([] { Experiment::Load("my.textproto"); }),
              AllOf(StartsWith(
                  "my.textproto: scenario.map (\"map.png\") and scenario.map_row (1 given) contradict")));
  const auto refusal = [](const std::string& more) {
    const std::string town(kTown);
    return ErrorOf([&] { Experiment::Parse(town.substr(0, town.size() - 1) + more + "}", "my"); });
  };
  EXPECT_THAT(refusal("grid { columns: 6 }"),
              AllOf(StartsWith("my: scenario.grid: 6 columns and 3 rows contradict scenario.map_row"),
                    EndsWith("which has 5 and 3; allowed: omitted, or those of the map")));
  EXPECT_THAT(refusal("start { column: 1 row: 1 }"), StartsWith("my: scenario.start: column 1, row 1"));
  EXPECT_THAT(refusal("start { column: 7 row: 1 }"),
              StartsWith("my: scenario.start.column: 7 is out of range"));
  EXPECT_THAT(refusal("stop { column: 2 row: 1 }"), StartsWith("my: scenario.stop: column 2, row 1"));
  EXPECT_THAT(refusal("sensor { x_m: 200 y_m: 0 }"), StartsWith("my: scenario.sensor[0].x_m"));
  EXPECT_THAT(
      refusal("random_sensors { count: 13 }"),
      AllOf(StartsWith("my: scenario.random_sensors: 13 sensors are too many"), HasSubstr("12 cells")));
  EXPECT_THAT(refusal("random_sensors { per_episode: true maximum: 20 }"),
              StartsWith("my: scenario.random_sensors: 20 sensors are too many"));
  EXPECT_THAT(ErrorOf([] { Experiment::Parse("scenario { map_row: \"SNS\" }", "my"); }),
              StartsWith("my: scenario.stop: column 2, row 0 is cut off from scenario.start"));
  EXPECT_THAT(ErrorOf([] { Experiment::Parse("scenario { map_row: \"S.s\" }", "my"); }),
              StartsWith("my: scenario.map_row[0]"));
}

TEST_F(MapTest, OfTheReadyExperimentIsACityInWhichEveryFieldCanBeFlown) {
  const Experiment experiment = Experiment::Load((kConfigs / "city.textproto").string());
  const auto& fields = dynamic_cast<const UavFields&>(experiment.world());
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const Scenario field = fields.Draw(seed);
    EXPECT_EQ(field.columns, 32);
    EXPECT_EQ(field.rows, 32);
    EXPECT_GE(field.sensors.size(), 3u);
    EXPECT_LE(field.sensors.size(), 10u);
    const UavWorld world(field);
    for (int sensor = 0; sensor < world.sensors(); ++sensor) {
      const Cell own = CellOf(field.sensors[static_cast<size_t>(sensor)], field.cell_m, 32, 32);
      EXPECT_TRUE(world.Covers(own, sensor));
      EXPECT_LT(world.Distance(field.start, own), ObstacleMap::kCutOff);
    }
  }
}

}  // namespace
}  // namespace fresco
