// Fidelity `auto` keeps its promise whatever the pattern of the beams: on the open line, what it
// chooses stays within the default tolerance, also on the frames held back, except where all
// effects together miss too much (far away, where few sub-rays meet grazing ground). Ten degrees to
// either side or five, and the whole of the rosette.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/fidelity/choice_report.h"
#include "core/fidelity/effect_search.h"
#include "railcast/fidelity.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/sensor_sector.h"

namespace railcast {
namespace {

ScenarioSpec OpenLineWith(const std::string& sensor) {
  const std::string scenarios = RAILCAST_SOURCE_DIR "/scenarios/";
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "scenario.json";
  std::ofstream(file) << R"({"version": 1, "fidelity": "auto", "file": ")" << scenarios
                      << R"(open_line.json", "lidar": {"file": ")" << scenarios << "sensors/"
                      << sensor
                      << R"(.json", "mount": {"position_m": [2.0, 0, 4.6], "pitch_deg": 3}}})";
  ScenarioSpec scenario = ReadScenario(file);
  // VLS-128 has as many beams in a sector half as wide as Pandar64.
  scenario.lidar.scan =
      CutSector(scenario.lidar.scan, {sensor == "vls128" ? 5.0 : 10.0, -90.0, 90.0});
  scenario.lidar.beam.reference_rays = 64;
  // The vehicle stops after 44 m, so that few windows have to be built.
  scenario.vehicle.motion.profile = {{0.0, {}, 22.2}, {4.0, {}, 0.0}};
  return scenario;
}

class FidelityAutoOn : public testing::TestWithParam<std::string> {};

TEST_P(FidelityAutoOn, StaysWithinTheToleranceOnTheOpenLine) {
  const ScenarioSpec scenario = OpenLineWith(GetParam());
  const auto simulator = MakeSimulator(scenario, 0);
  const FidelityChoice choice = ChooseFidelity(*simulator, scenario, [](double) {});
  EXPECT_TRUE(IsWithinOrAsFull(choice.deviation, choice.full_deviation, scenario.tolerance));
  EXPECT_LT(choice.deviation.missed_share, 0.1);
  for (const FidelityChoice::HeldBack& held : choice.held_back) {
    EXPECT_TRUE(held.is_within_tolerance) << "frame " << held.frame;
  }
  EXPECT_EQ(choice.held_back.size(), 3U);
  if (HasFailure()) ADD_FAILURE() << ChoiceText(choice);
}

INSTANTIATE_TEST_SUITE_P(Sensors,
                         FidelityAutoOn,
                         testing::Values("vir2rail", "pandar64", "vls128", "rosette"),
                         [](const auto& sensor) { return sensor.param; });

}  // namespace
}  // namespace railcast
