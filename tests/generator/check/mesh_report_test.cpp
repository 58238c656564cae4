#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

#include "generator/check/check_report.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

using testing::HasSubstr;

class MeshReport : public testing::Test {
 protected:
  ObjectSpec Write(const std::string& text) {
    std::ofstream(file_) << text;
    ObjectSpec spec;
    spec.name = "house";
    spec.type = ObjectType::kMesh;
    spec.file = file_.string();
    return spec;
  }
  static std::string Text(const std::vector<ObjectSpec>& objects) {
    return MeshesText(objects, RailLabels(), RailMaterials());
  }

  const TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_.path() / "house.obj";
};

/// Stands on z = 0.
constexpr const char* kGable =
    "v -2 -1 0\nv 2 -1 0\nv 0 1 3\nv 0 1 3\n"
    "usemtl Brick\nf 1 2 3\ng front\nf 1 2 3 4\nusemtl \x1b[31mGlass\nf 1 2 3\nf 1 2 2\nf 2 3 4\n";

TEST_F(MeshReport, IsEmptyWithoutMeshes) {
  ObjectSpec person;
  person.type = ObjectType::kPerson;
  EXPECT_EQ(Text({person}), "");
}

TEST_F(MeshReport, SaysWhatIsKeptAndWhatNotAndWhatEachPartIs) {
  const ObjectSpec house = Write(kGable);
  // Each triangle has an area of 0.5 x 4 x sqrt(4 + 9) = 7.211 m2.
  EXPECT_EQ(
      Text({house}),
      "meshes    \"house\": " + file_.string() +
          "\n"
          "          4 x 2 x 3 m, 3 triangles of 5 faces, 21.63 m²\n"
          "          left out: 2 triangles without area and 1 face with fewer than three "
          "different corners\n"
          "          \"Brick\": material masonry (by the word \"brick\"), label object (the "
          "type's), 2 triangles\n"
          "          \"\\u001b[31mGlass\": material glass (by the word \"glass\"), label object "
          "(the type's), 1 triangle\n");
}

TEST_F(MeshReport, SaysWhatItsReaderRemarked) {
  const std::string text = Text({Write("mtllib gone.mtl\n" + std::string(kGable))});
  EXPECT_NE(text.find("          remark: 1 material file, or material of one, that is not there: "
                      "\"gone.mtl\"\n"),
            std::string::npos)
      << text;
}

TEST_F(MeshReport, SaysHowFarAModelIsSimplified) {
  // A square with a peak of 2 mm, and a triangle elsewhere.
  ObjectSpec house = Write(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0.002\nv 5 0 0\nv 6 0 0\nv 5 0 1\n"
      "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 6 7 8\n");
  EXPECT_EQ(Text({house}).find("simplified"), std::string::npos);
  house.tolerance_mm = 1.5;
  EXPECT_NE(Text({house}).find("          simplified to 1.5 mm: no triangle can be left out\n"),
            std::string::npos)
      << Text({house});
  house.tolerance_mm = 4.0;
  const std::string text = Text({house});
  EXPECT_NE(text.find(", 3 triangles of 5 faces, "), std::string::npos) << text;
  EXPECT_NE(text.find("          simplified to 4 mm: 3 of 5 triangles, deviation 2 mm\n"),
            std::string::npos)
      << text;
}

TEST_F(MeshReport, NamesObjectsOfOneModelTogether) {
  ObjectSpec first = Write(kGable);
  ObjectSpec second = first;
  second.name = "other";
  second.s_m = 50.0;
  second.motion = MotionSpec{};
  ObjectSpec third = first;
  third.name = "third";
  third.material = "wood";
  const std::string text = Text({first, second, third});
  EXPECT_NE(text.find("meshes    \"house\" and 1 other: "), std::string::npos) << text;
  EXPECT_NE(text.find("          \"third\": "), std::string::npos) << text;
  EXPECT_NE(text.find("\"Brick\": material wood (the object's)"), std::string::npos) << text;
}

TEST_F(MeshReport, WarnsByNameOfAbsurdSizes) {
  ObjectSpec house = Write(kGable);
  EXPECT_EQ(Text({house}).find("WARNING"), std::string::npos);
  house.unit_m = 25.5;
  EXPECT_NE(Text({house}).find("WARNING: \"house\" is larger than 100 m: is its unit right?\n"),
            std::string::npos);
  house.unit_m = 24.5;  // 98 m.
  EXPECT_EQ(Text({house}).find("WARNING"), std::string::npos);
  house.unit_m = 0.0024;
  EXPECT_NE(Text({house}).find("WARNING: \"house\" is smaller than 1 cm: is its unit right?\n"),
            std::string::npos);
}

TEST_F(MeshReport, WarnsOfWhatIsMostlyBelowItsPlace) {
  ObjectSpec house = Write("v 0 5 -2\nv 1 5 -2\nv 0 6 1\nf 1 2 3\n");
  EXPECT_EQ(Text({house}).find("WARNING"), std::string::npos);
  house.origin = MeshOrigin::kFile;
  EXPECT_NE(
      Text({house}).find(
          "WARNING: \"house\" is mostly below the ground, down to 2 m: is its origin right?\n"),
      std::string::npos);
  house.h_m = 0.25;
  EXPECT_NE(Text({house}).find("is mostly below top of rail, down to 1.75 m"), std::string::npos);
  house.h_m = 0.6;
  EXPECT_EQ(Text({house}).find("WARNING"), std::string::npos);
}

TEST_F(MeshReport, WarnsWhereAFileSeemsToHaveYUp) {
  ObjectSpec car = Write("v -1 0 -2\nv 1 0 -2\nv 1 0 2\nv 0 1.5 0\nf 1 2 3\nf 1 2 4\nf 2 3 4\n");
  const std::string warning =
      "WARNING: \"house\" stands on the plane y = 0 of its file, not on z = 0: is its up \"y\"?\n";
  EXPECT_NE(Text({car}).find(warning), std::string::npos) << Text({car});
  car.up = UpAxis::kZ;
  EXPECT_NE(Text({car}).find(warning), std::string::npos);
  car.up = UpAxis::kY;
  EXPECT_EQ(Text({car}).find("WARNING"), std::string::npos);
}

/// The folder's own notes say that these have z up.
TEST(MeshReportOfRealFiles, RaisesNoFalseAlarmAboutTheUpwardAxis) {
  const std::filesystem::path folder =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "meshes_gazebo";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real meshes under " << folder;
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".obj") continue;
    ObjectSpec spec;
    spec.name = "it";
    spec.type = ObjectType::kMesh;
    spec.file = entry.path().string();
    const std::string text = MeshesText(std::vector{spec}, RailLabels(), RailMaterials());
    EXPECT_EQ(text.find("is its up"), std::string::npos) << text;
    ++num_files;
  }
  EXPECT_GE(num_files, 7);
}

/// A straight line with a loop from 300 to 700 m on its left, through which the vehicle runs.
ScenarioSpec RunThroughALoop(double speed_mps) {
  ScenarioSpec scenario = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/minimal.json");
  WorldSpec world;
  world.alignment.course = AlignmentElementsSpec{{{ElementType::kStraight, 1000.0, {}}}};
  world.tracks.push_back({.name = "loop",
                          .offset_m = 4.5,
                          .begin = TurnoutSpec{"main", 300.0, TurnoutType::k9_190, {}, {}},
                          .end = TurnoutSpec{"main", 700.0, TurnoutType::k9_300, {}, {}}});
  world.vegetation.grass = false;
  world.vegetation.trees_per_hectare = 0.0;
  scenario.world = world;
  scenario.vehicle = {};
  scenario.vehicle.route = {"main", "loop", "main"};
  scenario.vehicle.start_s_m = 250.0;
  scenario.vehicle.motion.profile = {{0.0, {}, speed_mps}};
  return scenario;
}

struct Loop {
  ScenarioSpec scenario;
  std::shared_ptr<const RailWorld> world;
  std::optional<LateralPeak> peak;

  explicit Loop(double speed_mps) : scenario(RunThroughALoop(speed_mps)) {
    world = MakeWorld(scenario);
    const VehicleWay way = FindVehicleWay(scenario.vehicle, world->vehicle_course());
    peak = FindLateralPeak(*world, scenario.vehicle, way);
  }
};

TEST(NetworkReport, NamesTracksWithTheirRadiiAndTurnouts) {
  const std::string text = NetworkText(*Loop(10.0).world);
  EXPECT_THAT(text, HasSubstr("tracks    \"main\": 1000 m from s 0 m to 1000 m, straight\n"));
  EXPECT_THAT(text, HasSubstr("turnout 1:9-190 of track \"loop\" at s 300 m: to the left, opens "
                              "with rising chainage, set diverging, fouling point at s 3"));
  EXPECT_THAT(text, HasSubstr("turnout 1:9-300 of track \"loop\" at s 700 m: to the left, opens "
                              "with falling chainage, set diverging, fouling point at s 6"));
  // Each S-curve is longer than its chainages: two arcs by 2 R (a - sin a), the straight between
  // them by what it rises times (1 - cos a) / sin a; 0.206 and 0.181 m.
  EXPECT_THAT(text,
              HasSubstr("\"loop\": 400.4 m from s 300 m to 700 m, tightest radius 190 m at s 3"));
}

TEST(NetworkReport, FindsTheLargestLateralAccelerationInTheTightestArc) {
  const Loop loop(10.0);
  ASSERT_TRUE(loop.peak);
  EXPECT_NEAR(loop.peak->acceleration_mps2, 100.0 / 190.0, 1e-3);
  EXPECT_EQ(loop.peak->balanced_mps2, 0.0);
  EXPECT_GE(loop.peak->point.s_m, 300.0);
  EXPECT_LT(loop.peak->point.s_m, 360.0);
  const std::string text = RouteText(*loop.world, loop.peak);
  EXPECT_THAT(text, HasSubstr("its route is \"main\", \"loop\", \"main\"\n"));
  EXPECT_THAT(text, HasSubstr("has its largest lateral acceleration of 0.5263 m/s^2 at s 3"));
}

TEST(NetworkReport, SaysWhatCantBalances) {
  ScenarioSpec scenario = RunThroughALoop(20.0);
  scenario.world.alignment.course = AlignmentElementsSpec{{{ElementType::kArc, 1000.0, 400.0}}};
  scenario.world.alignment.cants_mm = {{0.0, 100.0}};
  scenario.world.tracks.resize(1);
  scenario.vehicle.route.clear();
  const std::shared_ptr<const RailWorld> world = MakeWorld(scenario);
  const std::optional<LateralPeak> peak = FindLateralPeak(
      *world, scenario.vehicle, FindVehicleWay(scenario.vehicle, world->vehicle_course()));
  ASSERT_TRUE(peak);
  EXPECT_NEAR(peak->balanced_mps2, 9.80665 * 100.0 / 1500.0, 1e-9);
  EXPECT_NEAR(peak->acceleration_mps2, 400.0 / 400.0 - peak->balanced_mps2, 1e-6);
}

TEST(NetworkReport, IsEmptyOfASingleTrack) {
  ScenarioSpec scenario = RunThroughALoop(20.0);
  scenario.world.tracks.resize(1);
  scenario.vehicle.route.clear();
  const std::shared_ptr<const RailWorld> world = MakeWorld(scenario);
  EXPECT_EQ(NetworkText(*world), "");
  EXPECT_FALSE(FindLateralPeak(*world, scenario.vehicle,
                               FindVehicleWay(scenario.vehicle, world->vehicle_course())));
}

TEST(NetworkReport, NamesTheTracksThatATrackCrosses) {
  const auto world = MakeWorld(ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/diamond.json"));
  const std::string text = NetworkText(*world);
  // 16 m to the left at 1:9. Frogs 0.7175 m / tan(3.17 deg) = 12.95 m off, rails whole 2.25 m on.
  EXPECT_THAT(text, HasSubstr("crosses track \"works_line\" at s 144 m: 1:9, frogs and check rails "
                              "from s 128.8 m to 159.2 m\n"));
  EXPECT_THAT(text, HasSubstr("crosses track \"works_line\" at s 216 m: 1:9"));
}

}  // namespace
}  // namespace railcast
