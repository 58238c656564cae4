// Fidelity `auto` keeps its promise whatever the pattern of the beams: on the open line, the set of
// effects that it chooses stays within the default tolerance on the frames that it was chosen on
// and on those held back. Twenty degrees ahead, and the whole of the rosette.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/fidelity/choice_report.h"
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
  scenario.lidar.scan = CutSector(scenario.lidar.scan, {40.0, -90.0, 90.0});
  scenario.lidar.beam.reference_rays = 64;
  return scenario;
}

class FidelityAutoOn : public testing::TestWithParam<std::string> {};

TEST_P(FidelityAutoOn, StaysWithinTheToleranceOnTheOpenLine) {
  const ScenarioSpec scenario = OpenLineWith(GetParam());
  const auto simulator = MakeSimulator(scenario, 0);
  const FidelityChoice choice = ChooseFidelity(*simulator, scenario, [](double) {});
  EXPECT_TRUE(choice.is_within_tolerance);
  for (const FidelityChoice::HeldBack& held : choice.held_back) {
    const Deviation& d = held.deviation;
    EXPECT_TRUE(held.is_within_tolerance)
        << "frame " << held.frame << ": range " << d.range_m << " m, missed " << d.missed_share
        << ", false " << d.false_share << ", wires missed " << d.thin_missed_share << ", intensity "
        << d.intensity;
  }
  EXPECT_EQ(choice.held_back.size(), 3U);
  if (HasFailure()) ADD_FAILURE() << ChoiceText(choice, scenario.tolerance);
}

INSTANTIATE_TEST_SUITE_P(Sensors,
                         FidelityAutoOn,
                         testing::Values("vir2rail", "pandar64", "vls128", "rosette"),
                         [](const auto& sensor) { return sensor.param; });

}  // namespace
}  // namespace railcast
