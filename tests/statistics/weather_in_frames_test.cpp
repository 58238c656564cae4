// Tests weather and wet or snowy surfaces through the whole simulator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/detect/base/weather_optics.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Materials of these scenes.
constexpr std::uint16_t kGrey = 1;
constexpr std::uint16_t kSoil = 2;
constexpr std::uint16_t kSnow = 3;

MaterialLibrary Materials() {
  return MaterialLibrary(
      {{.name = "grey", .reflectivity = 0.5},
       {.name = "soil", .reflectivity = 0.25, .reflectivity_1550nm = 0.32, .facet_slope_deg = 20.0},
       {.name = "snow", .reflectivity = 0.9, .reflectivity_1550nm = 0.1, .facet_slope_deg = 10.0}});
}

Frame Scan(const std::shared_ptr<SimpleWorld>& world,
           const ScanPattern& pattern,
           const SimulatorSpec& spec) {
  return FrameBy(Simulator(world, pattern, Materials(), spec, 0));
}

std::size_t CountIn(const Frame& frame, Outcome outcome) {
  return static_cast<std::size_t>(std::count(frame.outcome.begin(), frame.outcome.end(), outcome));
}

std::shared_ptr<SimpleWorld> WallAt(double range_m) {
  return WorldOfParts({{MakeWall(static_cast<float>(range_m), 20.0F), kGrey, 1}});
}

// Ground 2 m below the sensor, and a wall at 40 m.
std::shared_ptr<SimpleWorld> GroundAndWall() {
  auto world = WallAt(40.0);
  world->ground.parts.push_back({MakeFloor(-2.0F, 300.0F), kSoil, 2});
  return world;
}

// All effects of the weather, with a hard threshold so that the maximum range is sharp.
SimulatorSpec HardSpec() {
  return {.detector = {.effects = {.surface_response = true,
                                   .surface_condition = true,
                                   .extinction = true,
                                   .detection = true}}};
}

// Solves rho e^(-2 alpha r) / r^2 = 0.1 / 200^2 for r.
double RangeMax_m(double reflectance, double extinction_per_m) {
  double near_m = 1.0;
  double far_m = 1000.0;
  for (int i = 0; i < 60; ++i) {
    const double r = 0.5 * (near_m + far_m);
    const bool is_seen = reflectance * std::exp(-2.0 * extinction_per_m * r) / (r * r) >= 2.5e-6;
    (is_seen ? near_m : far_m) = r;
  }
  return near_m;
}

void ExpectRangeMax(const SimulatorSpec& spec, double range_m) {
  // Over a field of view of 0.5 deg, incidence and range change by 2e-5.
  const ScanPattern pattern = MakeRaster(0.5, 0.5, 0.1);
  EXPECT_EQ(CountIn(Scan(WallAt(0.999 * range_m), pattern, spec), Outcome::kReturned), 25U);
  EXPECT_EQ(CountIn(Scan(WallAt(1.001 * range_m), pattern, spec), Outcome::kBelowThreshold), 25U);
}

TEST(WeatherInFrames, ShortensTheRangeAsTheClosedFormSays) {
  for (const double visibility_m : {20.0, 100.0, 500.0}) {
    SimulatorSpec spec = HardSpec();
    spec.detector.weather.visibility_m = visibility_m;
    ExpectRangeMax(spec, RangeMax_m(0.5, std::log(20.0) / visibility_m));
  }
  SimulatorSpec rain = HardSpec();
  rain.detector.weather.rain_rate_mmph = 50.0;
  rain.detector.weather.wetness = 0.0;
  ExpectRangeMax(rain, RangeMax_m(0.5, RainExtinction_per_m(rain.detector.weather)));
  SimulatorSpec snow = HardSpec();
  snow.detector.weather.snow_rate_mmph = 2.5;
  ExpectRangeMax(snow, RangeMax_m(0.5, SnowExtinction_per_m(snow.detector.weather, 905)));
}

// docs/physics.md 4.1 and 4.3: 447 m in clear air, 65 m at a visibility of 100 m.
TEST(WeatherInFrames, HasFogTakeSixSeventhsOfTheRangeAtAHundredMetres) {
  SimulatorSpec spec = HardSpec();
  spec.detector.range_max_m = 1000.0;
  ExpectRangeMax(spec, 447.2);
  spec.detector.weather.visibility_m = 100.0;
  EXPECT_NEAR(RangeMax_m(0.5, FogExtinction_per_m(spec.detector.weather)), 65.0, 0.5);
}

TEST(WeatherInFrames, LosesGroundWhenItIsWetAndMoreAt1550nm) {
  const ScanPattern pattern = MakeRaster(5.0, 5.0, 0.05);
  const auto ground = WorldOfParts({{MakeFloor(-2.0F, 400.0F), kSoil, 2}});
  const auto count = [&](const SimulatorSpec& spec) {
    return CountIn(Scan(ground, pattern, spec), Outcome::kReturned);
  };
  double lost_share = 0.0;
  for (const int wavelength_nm : {905, 1550}) {
    SimulatorSpec spec = HardSpec();
    spec.detector.beam.wavelength_nm = wavelength_nm;
    const std::size_t dry = count(spec);
    std::size_t before = dry;
    for (const double wetness : {0.3, 0.6, 1.0}) {
      spec.detector.weather.wetness = wetness;
      const std::size_t returns = count(spec);
      EXPECT_LT(returns, before) << wavelength_nm << " " << wetness;
      before = returns;
    }
    const double lost = 1.0 - static_cast<double>(before) / static_cast<double>(dry);
    EXPECT_GT(lost, lost_share) << wavelength_nm;
    lost_share = lost;
  }
}

// The intensity of every beam follows the closed form for the wet surface.
TEST(WeatherInFrames, GivesWetGroundTheReflectanceOfItsWetOptics) {
  SimulatorSpec spec = HardSpec();
  spec.detector.weather.wetness = 1.0;
  const Frame frame = Scan(GroundAndWall(), MakeRaster(20.0, 10.0, 0.5), spec);
  const double s = 0.75 * 20.0 * 3.14159265358979 / 180.0;
  const double diffuse = 0.25 * 0.6 * (1.0 - 0.02);
  std::size_t checked = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.label[slot] != 2) continue;
    const double c = std::cos(static_cast<double>(frame.incidence_rad[slot]));
    const double a = 1.0 - 0.5 * s * s / (s * s + 0.33);
    const double b = 0.45 * s * s / (s * s + 0.09);
    const double a2 = 0.15 * 0.15;
    const double g = c + std::sqrt(a2 + (1.0 - a2) * c * c);
    const double d = c * c * (a2 - 1.0) + 1.0;
    const double lobe = std::min(1.0, 2.0 * c * c) * 0.02 * a2 * c / (g * g * d * d);
    const double expected = diffuse * (a * c + b * (1.0 - c * c)) + lobe;
    EXPECT_NEAR(static_cast<double>(frame.intensity[slot]) / expected, 1.0, 2e-4);
    ++checked;
  }
  EXPECT_GT(checked, 100U);
}

// Returns the mean intensity of a label: 1 is the wall, 2 the ground.
double MeanIntensity(const Frame& frame, std::uint32_t label) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.label[slot] != label) continue;
    sum += static_cast<double>(frame.intensity[slot]);
    count += 1.0;
  }
  return sum / count;
}

TEST(WeatherInFrames, HasSnowCoverBrightenGroundAt905nmAndDarkenItAt1550nm) {
  const ScanPattern pattern = MakeRaster(20.0, 10.0, 0.5);
  for (const int wavelength_nm : {905, 1550}) {
    SimulatorSpec spec = HardSpec();
    spec.detector.beam.wavelength_nm = wavelength_nm;
    spec.snow_material = kSnow;
    const Frame bare = Scan(GroundAndWall(), pattern, spec);
    spec.detector.weather.snow_cover = 0.5;
    const Frame half = Scan(GroundAndWall(), pattern, spec);
    spec.detector.weather.snow_cover = 1.0;
    const Frame white = Scan(GroundAndWall(), pattern, spec);
    const bool brightens = wavelength_nm == 905;
    EXPECT_EQ(MeanIntensity(white, 2) > MeanIntensity(bare, 2), brightens);
    EXPECT_NEAR(MeanIntensity(half, 2), 0.5 * (MeanIntensity(bare, 2) + MeanIntensity(white, 2)),
                1e-6);
    EXPECT_EQ(MeanIntensity(white, 1), MeanIntensity(bare, 1)) << "snow lies on no wall";
  }
}

}  // namespace
}  // namespace railcast
