// Velocities along beams of echoes that no surface sends directly.
#include "core/simulate/velocity_meter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/core/simulate/measured_velocities.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

constexpr std::uint32_t kClutterLabel = 33;

TEST(VelocityOfClutter, OfMirrorImagesIsTheChangeOfTheWholePath) {
  const auto world = WorldOfParts({{MakeFloor(-2.0F, 100.0F), 1, 4}});
  const Vector3 wall_mps(-3.0, 1.0, 2.0);
  world->AddObject(SheetModel(20.0F), Transform(Eigen::Translation3d(30.0, 0.0, 0.0)), wall_mps);
  world->velocity_chunk_mps = {8.0, 0.0, 0.0};
  SimulatorSpec spec = Measuring();
  spec.detector.effects = {.surface_response = true, .mirror_paths = true, .detection = true};
  spec.detector.receiver.return_mode = ReturnMode::kLast;
  spec.detector.clutter_labels.mirror_image = kClutterLabel;
  const MaterialLibrary materials({{.name = "glass", .specular_f0 = 0.08, .height_rms_um = 0.0},
                                   {.name = "plaster", .reflectivity = 0.5}});
  const ScanPattern pattern = MakeRaster(40, 20, 0.5);
  const Frame frame = ScanFrame(Simulator(world, pattern, materials, spec, 0));
  std::size_t num_images = 0;
  ForEachFiring(frame, pattern, [&](std::size_t slot, const Vector3& direction, double) {
    if (frame.label[slot] != kClutterLabel) return;
    const Vector3 folded(direction.x(), direction.y(), -direction.z());
    EXPECT_NEAR(TrueAt(frame, slot),
                folded.dot(wall_mps) - direction.dot(world->velocity_chunk_mps), kRounding_mps);
    ++num_images;
  });
  EXPECT_GT(num_images, 100U);
}

TEST(VelocityOfClutter, OfGhostsIsTwiceThatOfTheirRetroreflector) {
  SimulatorSpec spec = Measuring();
  spec.detector.effects = {.surface_response = true, .detection = true, .ghost = true};
  spec.detector.receiver.return_mode = ReturnMode::kDual;
  spec.detector.receiver.ghost_reflectance = 1.0;
  spec.detector.cover.aperture_mm = 30.0;
  spec.detector.clutter_labels.ghost = kClutterLabel;
  const MaterialLibrary materials(
      {{.name = "soil"}, {.name = "sheeting", .reflectivity = 0.5, .retroreflectance = 1000.0}});
  const ScanPattern pattern = MakeRaster(4, 4, 1);
  const Frame frame =
      ScanFrame(Simulator(WorldWithWallAt(10.0, {6.0, 0.0, 0.0}), pattern, materials, spec, 1));
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += 2) {
    ASSERT_EQ(frame.label[slot + 1], kClutterLabel);
    EXPECT_NEAR(TrueAt(frame, slot + 1), 2.0 * TrueAt(frame, slot), kRounding_mps);
    EXPECT_NEAR(TrueAt(frame, slot), 6.0, 0.02);
  }
}

/// Expects that every echo of the air in an empty world moves as `air_mps` does.
void ExpectAir(const SimulatorSpec& spec, const Vector3& air_mps) {
  auto world = std::make_shared<SimpleWorld>();
  world->velocity_chunk_mps = {20.0, 0.0, 0.0};
  const ScanPattern pattern = MakeRaster(40, 40, 0.5);
  const Frame frame = ScanOnce(world, pattern, spec);
  std::size_t num_echoes = 0;
  ForEachFiring(frame, pattern, [&](std::size_t slot, const Vector3& direction, double) {
    if (frame.outcome[slot] != Outcome::kClutter) return;
    EXPECT_NEAR(TrueAt(frame, slot), direction.dot(air_mps - world->velocity_chunk_mps), 1e-4);
    ++num_echoes;
  });
  EXPECT_GT(num_echoes, 20U);
}

TEST(VelocityOfClutter, DropsAndFlakesFallAndDriftWithTheWind) {
  SimulatorSpec spec = Measuring();
  spec.detector.weather.wind_speed_mps = 9.0;
  spec.detector.weather.wind_direction_deg = 0.0;  // Towards -x.
  spec.detector.receiver.clutter_gain = 10.0;
  spec.detector.effects = {.surface_response = true, .detection = true, .clutter = true};
  spec.detector.weather.rain_rate_mmph = 20.0;
  // The median diameter is 0.895 x 20^0.21 = 1.679 mm.
  ExpectAir(spec, {-9.0, 0.0, -(9.65 - 10.3 * std::exp(-0.6 * 1.679))});
  spec.detector.weather.rain_rate_mmph = 0.0;
  spec.detector.weather.snow_rate_mmph = 5.0;
  ExpectAir(spec, {-9.0, 0.0, -1.0});
  // The published model's flakes, too.
  spec.detector.effects = {.snow = true};
  ExpectAir(spec, {-9.0, 0.0, -1.0});
}

TEST(VelocityOfClutter, FogDriftsWithTheWind) {
  SimulatorSpec spec = Measuring();
  spec.detector.weather.wind_speed_mps = 9.0;
  spec.detector.weather.wind_direction_deg = 90.0;  // Towards -y.
  spec.detector.effects = {.surface_response = true, .detection = true, .fog_echo = true};
  spec.detector.weather.fog_density_per_m = 0.1;
  ExpectAir(spec, {0.0, -9.0, 0.0});
}

TEST(VelocityOfClutter, PulsesOfOthersHaveAnyVelocityAndNoTrueOne) {
  SimulatorSpec spec = Measuring({.sigma_mps = 0.1, .max_mps = 40.0});
  spec.detector.effects = {.surface_response = true, .detection = true, .interference = true};
  spec.detector.receiver.foreign_pulses_hz = 1e6;
  const Frame frame = ScanOnce(std::make_shared<SimpleWorld>(), MakeRaster(40, 40, 0.5), spec);
  double sum_mps = 0.0;
  double squares_m2ps2 = 0.0;
  double num = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    EXPECT_TRUE(std::isnan(frame.true_radial_velocity_mps[slot]));
    if (std::isnan(frame.x[slot])) continue;
    const auto measured_mps = static_cast<double>(frame.radial_velocity_mps[slot]);
    ASSERT_LE(std::abs(measured_mps), 40.0);
    sum_mps += measured_mps;
    squares_m2ps2 += measured_mps * measured_mps;
    num += 1.0;
  }
  ASSERT_GT(num, 1000.0);
  // Uniform: variance 40^2 / 3; four standard errors.
  const double sigma_mps = 40.0 / std::sqrt(3.0);
  EXPECT_NEAR(sum_mps / num, 0.0, 4.0 * sigma_mps / std::sqrt(num));
  EXPECT_NEAR(squares_m2ps2 / num / (sigma_mps * sigma_mps), 1.0, 4.0 * std::sqrt(0.8 / num));
}

}  // namespace
}  // namespace railcast
