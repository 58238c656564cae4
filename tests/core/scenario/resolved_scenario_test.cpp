#include <gtest/gtest.h>

#include "core/scenario/descriptions.h"
#include "core/scenario/json_writer.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

class ShippedScenario : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedScenario, ReadsBackFromItsResolvedJson) {
  const ScenarioSpec spec = ReadScenario(GetParam());
  const TemporaryFolder folder;
  const std::string resolved = ResolvedScenarioJson(spec);
  const ScenarioSpec again = ReadScenario(folder.Write("resolved.json", resolved));
  EXPECT_EQ(again, spec);
  EXPECT_EQ(ResolvedScenarioJson(again), resolved);
}

TEST_P(ShippedScenario, ReadsBackFromItsShortJson) {
  ScenarioSpec spec = ReadScenario(GetParam());
  Json brief = {{"version", 1}};
  brief.update(JsonWriter::WriteShort(spec));
  const TemporaryFolder folder;
  EXPECT_EQ(ReadScenario(folder.Write("short.json", brief.dump())), spec);
  EXPECT_LT(brief.dump().size(), Json::parse(ResolvedScenarioJson(spec)).dump().size());
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         ShippedScenario,
                         testing::ValuesIn(ShippedScenarios()),
                         [](const auto& test) { return test.param.stem().string(); });

// A scenario in which every field differs from its default, so that the test notices a field that
// is not written.
// NOLINTNEXTLINE(readability-function-size): a value a line
ScenarioSpec UnusualScenario(const std::string& mesh_file) {
  ScenarioSpec spec;
  spec.seed = 0xFFFF'FFFF'FFFF'FFFFULL;
  spec.fidelity = Fidelity::kGeometry;
  spec.effects = {{"rain", true}, {"noise", false}};
  spec.lidar = {
      "odd",
      {12.5,
       SpinningSpec{
           {{-1.5, 0.1, 0}, {2.25, -0.1, 1.5}}, 50.1, 7, Rotation::kCounterclockwise, 12.0}},
      1.25,
      99.5,
      {{1, 2, 3}, 4, 5, 6},
      {0.2, 150, 0.02, 2e-4, NoiseShape::kBeam, 0.125, 1e-3, 0.25, 0.0625},
      {1550, {0.5, 0.25}, 3.5, 128},
      {90,
       6,
       EchoSignal::kEnergy,
       ReturnMode::kDual,
       0.01,
       0.2,
       0.02,
       0.05,
       0.06,
       0.07,
       0.03,
       0.4,
       3.0,
       0.7,
       8,
       0.3,
       1e-6,
       0.1,
       5,
       300.0,
       0.1}};
  spec.weather.fog_density_per_m = 0.01;
  spec.weather.fog_variation = 0.3;
  spec.weather.rain_rate_mmph = 3;
  spec.weather.rain_drop_sizes = RainDrops::kDrizzle;
  spec.weather.rain_dropout_per_m = 4e-4;
  spec.weather.rain_dropout_exponent = 0.7;
  spec.weather.snow_rate_mmph = 5;
  spec.weather.snow_type = SnowType::kWet;
  spec.weather.snow_echoes_per_mmph = 0.03;
  spec.weather.snow_range_scale_m = 6;
  spec.weather.snow_intensity = 0.04;
  spec.weather.wetness = 0.5;
  spec.weather.snow_cover = 0.75;
  spec.weather.sun = {80, 45, 20};
  spec.interfaces.udp = {"localhost:1", "[::1]:65535"};
  spec.camera = {640,
                 480,
                 62.5,
                 "front",
                 2.5,
                 MountSpec{{4, 5, 6}, 1, 2, 3},
                 DistortionSpec{-0.1, 0.02, 0.001, -0.002, 0.003},
                 {"localhost:2"}};
  spec.world.seed = 0xFFFF'FFFF'FFFF'FFFEULL;
  spec.world.alignment = {AlignmentSplineSpec{{{0, 0}, {100, 0.1}}},
                          "a survey",
                          {1, 2, 3},
                          45,
                          {{0, 1.5}},
                          {{0, 80}},
                          {{0, 20}, {50, -30}},
                          1000,
                          10,
                          11,
                          12,
                          13,
                          14};
  spec.world.tracks = {
      {"a", 1, {}, {}, 0, 2, 3.0, {}, {}, SleeperType::kWood, false},
      {"b", {}, {{0, -4}, {9, -5}}, {}, 0, 0, {}, {}, {}, SleeperType::kConcrete, true},
      {"c",
       {},
       {},
       {{ElementType::kArc, 5, 300.0}},
       0,
       0,
       {},
       TurnoutSpec{"a", 1, TurnoutType::k12_500, TrackSide::kRight, TurnoutPosition::kDiverging},
       {},
       SleeperType::kConcrete,
       true}};
  spec.world.yards = {
      {"y", {"a", 5, TurnoutType::k9_190, TrackSide::kLeft, {}}, 3, 5, 50, {}, true}};
  spec.world.catenary = {false, 5.4, 1.7, 60, 0.3, 7, 3.2};
  spec.world.terrain = {
      70, 0.03, 1.9, 0.5, ElevationSpec{mesh_file, {1, 2, 3}}, {}, GroundCover::kFields};
  spec.world.vegetation = {30, 8, 5, 13, 0.5, 50, 20, 7, false, 3.5, 8.5, 12};
  spec.world.objects = {{"x",
                         ObjectType::kMesh,
                         "b",
                         1,
                         2,
                         3,
                         4,
                         {{5, 6, 7}},
                         mesh_file,
                         UpAxis::kY,
                         0.001,
                         "rail",
                         "soil",
                         MotionSpec{{{{}, 8.0, 9}}, true}}};
  spec.vehicle.track = "b";
  spec.vehicle.start_s_m = 10;
  spec.vehicle.motion.profile = {{1.0, {}, 2}, {3.0, {}, 0}};
  spec.vehicle.motion.reverse = true;
  spec.vehicle.ego_boxes_m = {{-1, -2, -3, 1, 2, 3}};
  spec.output = {OutputFrame::kWorld, Handedness::kLeft, {1e6, -2, 3.5}};
  spec.materials = {{"soil", 0.25, 0.3, 20, 0.02, 0.03, 0.15, 570, 0.4}};
  spec.labels = {{1, "rail", {1, 2, 3}, "Rails", "track", 260, 49}};
  return spec;
}

TEST(ResolvedScenario, HoldsEveryField) {
  const TemporaryFolder folder;
  const ScenarioSpec spec = UnusualScenario(folder.Write("x.obj", "").string());
  const auto file = folder.Write("resolved.json", ResolvedScenarioJson(spec));
  EXPECT_EQ(ReadScenario(file), spec);
}

TEST(ResolvedScenario, HoldsTheVisibilityInsteadOfTheFogDensity) {
  const TemporaryFolder folder;
  ScenarioSpec spec = UnusualScenario(folder.Write("x.obj", "").string());
  spec.weather.fog_density_per_m = 0.0;
  spec.weather.visibility_m = 120;
  EXPECT_EQ(ReadScenario(folder.Write("resolved.json", ResolvedScenarioJson(spec))), spec);
}

TEST(ResolvedScenario, HoldsOtherCoursesAndPatterns) {
  const TemporaryFolder folder;
  ScenarioSpec spec = UnusualScenario(folder.Write("x.obj", "").string());
  spec.lidar.scan.pattern = FiringTableSpec{folder.Write("x.csv", "").string()};
  spec.world.alignment.course = AlignmentElementsSpec{{{ElementType::kStraight, 10, {}},
                                                       {ElementType::kClothoid, 11, {}},
                                                       {ElementType::kArc, 12, -300.0}}};
  EXPECT_EQ(ReadScenario(folder.Write("resolved.json", ResolvedScenarioJson(spec))), spec);
  spec.lidar.scan.pattern = RasterSpec{60, 30, 0.5, RasterOrder::kRows};
  spec.world.alignment.course = AlignmentSectionsSpec{500, {{0, {}, 300.0}, {50, 300.0, -300.0}}};
  EXPECT_EQ(ReadScenario(folder.Write("resolved.json", ResolvedScenarioJson(spec))), spec);
}

TEST(ResolvedScenario, HoldsPlacesOnTheMapAsTheyWereGiven) {
  const TemporaryFolder folder;
  ScenarioSpec spec = UnusualScenario(folder.Write("x.obj", "").string());
  spec.world.alignment.map = MapSpec{{1, 2}, 15.5, 48.25, {{3, 4}, {5, 6}}};
  ObjectSpec& object = spec.world.objects.front();
  object.s_m = object.d_m = 0.0;
  object.x_m = 50;
  object.y_m = 5;
  EXPECT_EQ(ReadScenario(folder.Write("resolved.json", ResolvedScenarioJson(spec))), spec);
  object.x_m = object.y_m = {};
  object.longitude_deg = 15.5;
  object.latitude_deg = 48.25;
  EXPECT_EQ(ReadScenario(folder.Write("resolved.json", ResolvedScenarioJson(spec))), spec);
}

// What a reader assumes is that of the key's owner: a yard's sleepers are of wood, a track's are
// not.
TEST(ShortJson, LeavesOutOnlyWhatAReaderAssumesAtThatPlace) {
  YardSpec yard{.name = "yard", .begin = {.track = "main", .s_m = 100.0}};
  EXPECT_EQ(JsonWriter::WriteShort(yard).dump(),
            R"({"name":"yard","begin":{"track":"main","s_m":100.0,"turnout":"1:9-190"},)"
            R"("num_tracks":1,"usable_length_m":100.0})");
  yard.sleeper = SleeperType::kConcrete;
  EXPECT_EQ(JsonWriter::WriteShort(yard)["sleeper"], "concrete");
  TrackSpec track;
  track.begin = TurnoutSpec{.track = "main", .position = TurnoutPosition::kDiverging};
  track.sleeper = SleeperType::kWood;
  EXPECT_EQ(JsonWriter::WriteShort(track).dump(),
            R"({"begin":{"track":"main","turnout":"1:9-190","position":"diverging"},)"
            R"("sleeper":"wood"})");
}

}  // namespace
}  // namespace railcast
