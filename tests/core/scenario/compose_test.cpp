#include <gtest/gtest.h>

#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

TEST(CheckScenario, FindsNoFaultInAnyShippedScenario) {
  for (const auto& file : ShippedScenarios()) {
    EXPECT_EQ(CheckScenario(file), std::vector<std::string>{}) << file;
  }
}

TEST(CheckScenario, ReportsThePatternAndTheWorldTogether) {
  const TemporaryFolder folder;
  const auto file = folder.Write("two.json", R"({
    "version": 1,
    "file": ")" + (ScenariosDir() / "minimal.json").string() +
                                                 R"(",
    "lidar": {"scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 60,
      "vertical_fov_deg": 30, "angular_resolution_deg": 0.7}}},
    "world": {"alignment": {"course": {"type": "sections", "length_m": 9,
      "sections": [{"s_m": 3}]}}}
  })");
  const std::vector<std::string> faults = CheckScenario(file);
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_TRUE(faults[0].starts_with(file.string() + ": /lidar/scan/pattern/horizontal_fov_deg: "));
  EXPECT_TRUE(faults[1].starts_with(file.string() + ": /lidar/scan/pattern/vertical_fov_deg: "));
  EXPECT_TRUE(faults[2].starts_with(file.string() + ": /world/alignment/course/sections/0/s_m: "));
}

TEST(MakeSimulator, PutsTheSensorWhereTheMountSays) {
  ScenarioSpec spec = ReadScenario(ScenariosDir() / "minimal.json");
  spec.lidar.mount.position_m = {2.0, 0.5, 3.0};
  spec.lidar.mount.yaw_deg = 90.0;
  const auto simulator = MakeSimulator(spec, 1);
  const Transform vehicle_from_sensor =
      simulator->world().WorldFromVehicle(0).inverse() * simulator->WorldFromSensor(0);
  // World positions reach 1e3 m, where a double's step is 1e-13 m; a few products add up.
  constexpr double kRoundOff_m = 1e-11;
  EXPECT_LT((vehicle_from_sensor.translation() - Vector3(2.0, 0.5, 3.0)).norm(), kRoundOff_m);
  EXPECT_LT((vehicle_from_sensor.linear() * Vector3::UnitX() - Vector3::UnitY()).norm(),
            kRoundOff_m);
}

TEST(MakeSimulator, NamesTheFileWhoseEffectsDoNotFitAnotherRung) {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.json", R"({"version": 1, "file": ")" +
                                               (ScenariosDir() / "minimal.json").string() +
                                               R"(", "effects": {"rain": true}})");
  ScenarioSpec spec = ReadScenario(file);
  spec.fidelity = Fidelity::kSurface;
  EXPECT_EQ(MessageOf([&] { static_cast<void>(MakeSimulator(spec, 1)); }),
            file.string() +
                R"(: /effects: "rain" of the published model and "surface_response" of physics )"
                "must not both be on");
}

}  // namespace
}  // namespace railcast
