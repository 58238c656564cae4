// Coarser plants, ground and tracks far away against full detail everywhere: what a sensor measures
// of them must stay. docs/results/detail.md has the comparison with intervals, by sensor.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "core/base/units.h"
#include "railcast/scenario.h"
#include "tests/stability/regime.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

struct Echoes {
  double count{};
  double intensity{};  ///< Their sum.
};
/// Echoes by label and by range.
using EchoesByPlace = std::map<std::pair<std::string, int>, Echoes>;

/// The demo without objects and weather. Its vehicle moves 62 m from frame to frame.
ScenarioSpec Demo(Fidelity rung, SceneDetail detail) {
  ScenarioSpec spec = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/st_gallen_approach.json");
  spec.fidelity = rung;
  spec.weather = {};
  spec.world.objects.clear();
  spec.world.detail = detail;
  spec.vehicle.motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 620.0}};
  spec.lidar.receiver.return_mode = ReturnMode::kTriple;
  return spec;
}

EchoesByPlace EchoesOf(const ScenarioSpec& spec, std::uint32_t num_frames) {
  constexpr double kBin_m = 60.0;
  const auto simulator = MakeSimulator(spec, 2);
  const LabelTable labels(spec.labels);
  EchoesByPlace echoes;
  Frame frame;
  for (std::uint32_t index = 0; index < num_frames; ++index) {
    simulator->Scan(index, frame);
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (frame.outcome[slot] != Outcome::kReturned) continue;
      const int bin = static_cast<int>(static_cast<double>(frame.true_range_m[slot]) / kBin_m);
      Echoes& of_place = echoes[{labels.Find(frame.label[slot])->name, bin}];
      of_place.count += 1.0;
      of_place.intensity += static_cast<double>(frame.intensity[slot]);
    }
  }
  return echoes;
}

/// Expects every count above 1,000 to change by less than 5 % and the noise of two Poisson counts,
/// and so the mean intensity, which varies less than its mean from echo to echo.
void ExpectAlike(const EchoesByPlace& full, const EchoesByPlace& coarser) {
  int num_compared = 0;
  for (const auto& [place, of_full] : full) {
    if (of_full.count < 1000.0) continue;
    ++num_compared;
    const Echoes& now = coarser.at(place);
    const double tolerance = 0.05 + 3.0 * std::sqrt(2.0 / of_full.count);
    const std::string where = place.first + " in bin " + std::to_string(place.second) + ", " +
                              std::to_string(of_full.count) + " echoes";
    EXPECT_NEAR(now.count / of_full.count, 1.0, tolerance) << where;
    EXPECT_NEAR(now.intensity / now.count * of_full.count / of_full.intensity, 1.0, tolerance)
        << where;
  }
  EXPECT_GE(num_compared, 8);
}

TEST(SceneDetail, KeepsTheEchoesOfRaysByLabelAndRange) {
  RecordRegime(
      "plants and ground coarser far away",
      {"-", "numbers and intensities of echoes within 5 % and chance, by class and range"});
  ExpectAlike(EchoesOf(Demo(Fidelity::kSurface, SceneDetail::kFull), 6),
              EchoesOf(Demo(Fidelity::kSurface, SceneDetail::kAuto), 6));
}

TEST(SceneDetail, KeepsTheEchoesOfBeamsByLabelAndRange) {
  ExpectAlike(EchoesOf(Demo(Fidelity::kFootprint, SceneDetail::kFull), 3),
              EchoesOf(Demo(Fidelity::kFootprint, SceneDetail::kAuto), 3));
}

// Blades two thirds as wide as these beams are 8 % brighter between 60 and 120 m.
TEST(SceneDetail, KeepsTheGrassOfNarrowBeams) {
  const auto narrow = [](SceneDetail detail) {
    ScenarioSpec spec = Demo(Fidelity::kFootprint, detail);
    spec.lidar.scan.pattern = RasterSpec{
        .horizontal_fov_deg = 16.0, .vertical_fov_deg = 4.0, .angular_resolution_deg = 0.05};
    spec.lidar.beam.divergence_mrad = {0.9, 0.9};
    return spec;
  };
  const std::pair<std::string, int> place{"grass", 1};
  const Echoes full = EchoesOf(narrow(SceneDetail::kFull), 10).at(place);
  const Echoes coarser = EchoesOf(narrow(SceneDetail::kAuto), 10).at(place);
  ASSERT_GT(full.count, 3000.0);
  EXPECT_NEAR(coarser.count / full.count, 1.0, 0.02);
  EXPECT_NEAR(coarser.intensity / coarser.count * full.count / full.intensity, 1.0, 0.03);
}

TEST(SceneDetail, HoldsForTreesThatSwayInTheWind) {
  ScenarioSpec full = Demo(Fidelity::kSurface, SceneDetail::kFull);
  ScenarioSpec coarser = Demo(Fidelity::kSurface, SceneDetail::kAuto);
  full.weather.wind_speed_mps = 10.0;
  coarser.weather.wind_speed_mps = 10.0;
  ExpectAlike(EchoesOf(full, 4), EchoesOf(coarser, 4));
}

/// The demo's vehicle, standing, before 60 persons who walk up to 150 m ahead of it.
Frame CrowdIn(SceneDetail detail) {
  ScenarioSpec spec = Demo(Fidelity::kGeometry, detail);
  spec.vehicle.motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 0.0}};
  spec.lidar.receiver.return_mode = ReturnMode::kStrongest;
  for (int i = 0; i < 60; ++i) {
    ObjectSpec person = ObjectAt("person " + std::to_string(i), ObjectType::kPerson,
                                 spec.vehicle.start_s_m + 6.0 + 2.4 * i, 1.5 * (i % 7 - 3));
    person.motion = MotionSpec{.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 1.3}}};
    spec.world.objects.push_back(std::move(person));
  }
  Frame frame;
  MakeSimulator(spec, 2)->Scan(3, frame);
  return frame;
}

// The spacing is 0.25 degrees. Where a beam meets a limb's edge, it may meet the other limb or the
// ground instead, or a surface that it grazes: these are few.
TEST(SceneDetail, KeepsWhoWalksWithinAnEighthOfTheSpacing) {
  const Frame full = CrowdIn(SceneDetail::kFull);
  const Frame coarser = CrowdIn(SceneDetail::kAuto);
  double num_full = 0.0;
  double num_coarser = 0.0;
  double num_common = 0.0;
  double num_near = 0.0;
  for (std::size_t slot = 0; slot < full.num_slots(); ++slot) {
    if (full.instance[slot] != 0) ++num_full;
    if (coarser.instance[slot] != 0) ++num_coarser;
    if (full.instance[slot] == 0 || coarser.instance[slot] != full.instance[slot]) continue;
    ++num_common;
    const auto range_m = static_cast<double>(full.true_range_m[slot]);
    const double off_m = std::abs(static_cast<double>(coarser.true_range_m[slot]) - range_m);
    if (off_m <= RadFromDeg(0.25) * range_m / 8.0) ++num_near;
  }
  ASSERT_GT(num_full, 500.0);
  EXPECT_NEAR(num_coarser / num_full, 1.0, 0.01);
  EXPECT_GT(num_common, 0.97 * num_full);
  EXPECT_GT(num_near, 0.97 * num_common);
}

}  // namespace
}  // namespace railcast
