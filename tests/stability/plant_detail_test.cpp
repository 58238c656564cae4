// Coarser plants far away against plants in full detail everywhere: what a sensor measures of them
// must stay. docs/detail.md has the comparison with intervals, by sensor.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "railcast/scenario.h"

namespace railcast {
namespace {

/// Echoes by label and by range.
using Counts = std::map<std::pair<std::string, int>, double>;

/// The demo without objects and weather. Its vehicle moves 62 m from frame to frame.
ScenarioSpec Demo(Fidelity rung, PlantDetail detail) {
  ScenarioSpec spec = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/st_gallen_approach.json");
  spec.fidelity = rung;
  spec.weather = {};
  spec.world.objects.clear();
  spec.world.vegetation.detail = detail;
  spec.vehicle.motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 620.0}};
  spec.lidar.receiver.return_mode = ReturnMode::kTriple;
  return spec;
}

Counts EchoesOf(const ScenarioSpec& spec, std::uint32_t num_frames) {
  constexpr double kBin_m = 60.0;
  const auto simulator = MakeSimulator(spec, 2);
  const LabelTable labels(spec.labels);
  Counts counts;
  Frame frame;
  for (std::uint32_t index = 0; index < num_frames; ++index) {
    simulator->Scan(index, frame);
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (frame.outcome[slot] != Outcome::kReturned) continue;
      const int bin = static_cast<int>(static_cast<double>(frame.true_range_m[slot]) / kBin_m);
      counts[{labels.Find(frame.label[slot])->name, bin}] += 1.0;
    }
  }
  return counts;
}

/// Expects every count above 1,000 to change by less than 5 % and the noise of two Poisson counts.
void ExpectAlike(const Counts& full, const Counts& coarser) {
  int num_compared = 0;
  for (const auto& [place, count] : full) {
    if (count < 1000.0) continue;
    ++num_compared;
    EXPECT_NEAR(coarser.at(place) / count, 1.0, 0.05 + 3.0 * std::sqrt(2.0 / count))
        << place.first << " in bin " << place.second << ", " << count << " echoes";
  }
  EXPECT_GE(num_compared, 8);
}

TEST(PlantDetail, KeepsTheEchoesOfRaysByLabelAndRange) {
  ExpectAlike(EchoesOf(Demo(Fidelity::kSurface, PlantDetail::kFull), 6),
              EchoesOf(Demo(Fidelity::kSurface, PlantDetail::kAuto), 6));
}

TEST(PlantDetail, KeepsTheEchoesOfBeamsByLabelAndRange) {
  ExpectAlike(EchoesOf(Demo(Fidelity::kFootprint, PlantDetail::kFull), 3),
              EchoesOf(Demo(Fidelity::kFootprint, PlantDetail::kAuto), 3));
}

TEST(PlantDetail, HoldsForTreesThatSwayInTheWind) {
  ScenarioSpec full = Demo(Fidelity::kSurface, PlantDetail::kFull);
  ScenarioSpec coarser = Demo(Fidelity::kSurface, PlantDetail::kAuto);
  full.weather.wind_speed_mps = 10.0;
  coarser.weather.wind_speed_mps = 10.0;
  ExpectAlike(EchoesOf(full, 4), EchoesOf(coarser, 4));
}

}  // namespace
}  // namespace railcast
