
#include <gtest/gtest.h>

#include <limits>

#include "core/scenario/track_limits.h"
#include "tests/core/io/message_of.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

// A vehicle that reaches 2 m beyond its origin, on a straight line towards a wagon of 14.04 m.
class VehicleClearance : public testing::Test {
 protected:
  static ScenarioSpec Shipped() {
    ScenarioSpec scenario = ReadScenario(ScenariosDir() / "brake_wagon.json");
    scenario.vehicle.may_overlap = false;
    scenario.vehicle.motion = {};
    return scenario;
  }
  // Returns the error for frames 0 to `last`, at 10 frames/s.
  [[nodiscard]] std::string Message(std::uint32_t last) const {
    const auto world = MakeWorld(scenario_);
    const ScanPattern pattern = BuildScanPattern(scenario_.lidar.scan);
    return MessageOf([&] { CheckVehicleIsClear(scenario_, *world, pattern, 0, last); });
  }
  void StandWithFrontAt(double s_m) { scenario_.vehicle.start_s_m = s_m - 2.0; }
  void RunWithFrontFrom(double s_m, double speed_mps) {
    StandWithFrontAt(s_m);
    scenario_.vehicle.motion = {{{.time_s = 0.0, .s_m = {}, .speed_mps = speed_mps}}, false};
  }

  ScenarioSpec scenario_ = Shipped();
  const std::string fault_ = (ScenariosDir() / "brake_wagon.json").string() +
                             ": /vehicle: must not be inside an object unless may_overlap is true "
                             "(got ";
  // Where the wagon's buffers end.
  static constexpr double kBuffers_m = 600.0 - 7.02;
};

TEST_F(VehicleClearance, LetsBuffersTouch) {
  StandWithFrontAt(kBuffers_m);
  EXPECT_EQ(Message(1000), "no error");
  StandWithFrontAt(kBuffers_m + 0.019);
  EXPECT_EQ(Message(1000), "no error");
}

TEST_F(VehicleClearance, NamesFrameObjectAndDepth) {
  StandWithFrontAt(kBuffers_m + 0.3);
  EXPECT_EQ(Message(0), fault_ + "0.30 m inside \"wagon\" at frame 0 (0 s))");
  // Nothing moves, so that later frames need not be looked at.
  EXPECT_EQ(Message(std::numeric_limits<std::uint32_t>::max() / 2),
            fault_ + "0.30 m inside \"wagon\" at frame 0 (0 s))");
}

TEST_F(VehicleClearance, FindsTheFrameInWhichTheVehicleRunsIntoAnObject) {
  // Frame 10 is 1 cm short of the buffers, frame 11 is 9 cm in.
  RunWithFrontFrom(kBuffers_m - 1.01, 1.0);
  EXPECT_EQ(Message(10), "no error");
  EXPECT_EQ(Message(11), fault_ + "0.09 m inside \"wagon\" at frame 11 (1.1 s))");
  EXPECT_EQ(Message(200), fault_ + "0.09 m inside \"wagon\" at frame 11 (1.1 s))");
}

TEST_F(VehicleClearance, ListsEveryObjectOnce) {
  ObjectSpec crate = ObjectAt("crate", ObjectType::kBox, kBuffers_m - 3.5);
  crate.h_m = 1.0;
  crate.size_m = {1.0, 1.0, 1.0};
  scenario_.world.objects.push_back(crate);
  RunWithFrontFrom(kBuffers_m - 5.0, 1.0);
  // The crate begins 1 m ahead.
  EXPECT_EQ(Message(60), fault_ + "0.10 m inside \"crate\" at frame 11 (1.1 s))\n" + fault_ +
                             "0.10 m inside \"wagon\" at frame 51 (5.1 s))");
}

TEST_F(VehicleClearance, IsNotAskedForWhereTheScenarioAllowsOverlaps) {
  scenario_.vehicle.may_overlap = true;
  StandWithFrontAt(kBuffers_m + 5.0);
  EXPECT_EQ(Message(10), "no error");
}

TEST_F(VehicleClearance, HoldsForNothingWithoutABody) {
  scenario_.vehicle.ego_boxes_m.clear();
  StandWithFrontAt(kBuffers_m + 5.0);
  EXPECT_EQ(Message(10), "no error");
}

TEST(ShippedScenarios, ClearanceHasAWagonEightCentimetresBesideTheVehicle) {
  ScenarioSpec scenario = ReadScenario(ScenariosDir() / "clearance.json");
  const auto message = [&](double wider_m) {
    constexpr std::size_t kLeft = 4;
    scenario.vehicle.ego_boxes_m[0][kLeft] = 1.45 + wider_m;
    const ScanPattern pattern = BuildScanPattern(scenario.lidar.scan);
    constexpr std::uint32_t kStandsBeforeTheNext = 250;
    return MessageOf([&] {
      CheckVehicleIsClear(scenario, *MakeWorld(scenario), pattern, 0, kStandsBeforeTheNext);
    });
  };
  EXPECT_EQ(message(0.08), "no error");
  EXPECT_NE(message(0.11).find("inside \"close_wagon\" at frame "), std::string::npos);
}

TEST(ShippedScenarios, KeepTheirVehiclesOutOfTheirObjects) {
  constexpr std::int64_t kTenMinutes_ns = 600'000'000'000;
  for (const auto& file : ShippedScenarios()) {
    SCOPED_TRACE(file.string());
    const ScenarioSpec scenario = ReadScenario(file);
    const ScanPattern pattern =
        BuildScanPattern(PickSensor(scenario, SensorNames(scenario).front()).lidar.scan);
    const auto world = MakeWorld(scenario);
    const std::uint32_t last =
        LastFrameOnTracks(scenario, *world, pattern, LastFrameBefore(pattern, kTenMinutes_ns));
    EXPECT_EQ(MessageOf([&] { CheckVehicleIsClear(scenario, *world, pattern, 0, last); }),
              "no error");
  }
}

}  // namespace
}  // namespace railcast
