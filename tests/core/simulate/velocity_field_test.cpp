#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/units.h"
#include "core/simulate/frame_motion.h"
#include "core/simulate/velocity_meter.h"
#include "tests/core/simulate/measured_velocities.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

constexpr std::int64_t kFrame_ns = 100'000'000;

// A thing that flies along a parabola and turns about an axis of its own.
const Vector3 kFlightStart_m(120.0, -30.0, 2.0);
const Vector3 kFlight_mps(30.0, -4.0, 0.5);
const Vector3 kFlight_mps2(-2.0, 1.0, 0.3);
const Vector3 kFlightTurn_radps(0.4, -1.5, 3.0);

Eigen::Affine3d FlightAt(std::int64_t time_ns) {
  const double t = SecondsFromNs(time_ns);
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  place.translation() = kFlightStart_m + t * kFlight_mps + 0.5 * t * t * kFlight_mps2;
  place.linear() = Eigen::AngleAxisd(t * kFlightTurn_radps.norm(), kFlightTurn_radps.normalized())
                       .toRotationMatrix();
  return place;
}

Vector3 VelocityInFlight_mps(std::int64_t time_ns, const Vector3& place_m) {
  const Vector3 arm_m = place_m - FlightAt(time_ns).translation();
  return kFlight_mps + SecondsFromNs(time_ns) * kFlight_mps2 + kFlightTurn_radps.cross(arm_m);
}

std::vector<Eigen::Affine3d> InFlight(std::int64_t time_ns) {
  return {FlightAt(time_ns)};
}

TEST(VelocityField, IsThatOfARigidBodyAtItsSteps) {
  const VelocityFields fields = VelocityFieldsOf(&InFlight, kFrame_ns, 5).front();
  ASSERT_EQ(fields.size(), 6U);
  for (std::int64_t step = 0; step <= 5; ++step) {
    const std::int64_t time_ns = kFrame_ns * step / 5;
    const Vector3 place_m = FlightAt(time_ns) * Vector3(2.0, -1.0, 3.0);
    // (w 0.5 ms)^2 / 3 of 3.4 rad/s x 3.7 m is 0.012 mm/s.
    EXPECT_LT((VelocityAt_mps(fields, static_cast<double>(step) / 5.0, place_m) -
               VelocityInFlight_mps(time_ns, place_m))
                  .norm(),
              2e-5)
        << step;
  }
}

TEST(VelocityField, IsLinearBetweenSteps) {
  const VelocityFields fields = VelocityFieldsOf(&InFlight, kFrame_ns, 10).front();
  for (const std::int64_t time_ns : {3'000'000, 47'500'000, 99'000'000}) {
    const Vector3 place_m = FlightAt(time_ns) * Vector3(2.0, -1.0, 3.0);
    const double shutter = static_cast<double>(time_ns) / kFrame_ns;
    // At one place, the velocity of what turns past it bends by w^2 v + w a: dt^2 / 8 of
    // 3.4^2 x 43 + 2 x 3.4 x 2.2 m/s^3 is 6 mm/s.
    EXPECT_LT(
        (VelocityAt_mps(fields, shutter, place_m) - VelocityInFlight_mps(time_ns, place_m)).norm(),
        7e-3)
        << time_ns;
  }
}

// What starts walking with the frame has its full speed from then on.
TEST(VelocityField, AsksForNoPlaceBeforeTheStampNorAfterTheFrame) {
  std::vector<std::int64_t> asked_ns;
  const PlacesAt places_at = [&](std::int64_t time_ns) {
    asked_ns.push_back(time_ns);
    const double x_m = 1.4 * std::max(0.0, SecondsFromNs(time_ns));
    return std::vector<Eigen::Affine3d>{Eigen::Affine3d(Eigen::Translation3d(x_m, 0.0, 0.0))};
  };
  const VelocityFields fields = VelocityFieldsOf(places_at, kFrame_ns, 2).front();
  EXPECT_EQ(*std::ranges::min_element(asked_ns), 0);
  EXPECT_EQ(*std::ranges::max_element(asked_ns), kFrame_ns);
  for (const double shutter : {0.0, 0.3, 1.0}) {
    EXPECT_NEAR(VelocityAt_mps(fields, shutter, Vector3::Zero()).x(), 1.4, 1e-9);
  }
}

TEST(VelocityField, OfAFrameWithoutDurationIsThatAtTheStamp) {
  const VelocityFields fields = VelocityFieldsOf(&InFlight, 0, 0).front();
  ASSERT_EQ(fields.size(), 1U);
  EXPECT_LT((VelocityAt_mps(fields, 0.0, kFlightStart_m) - kFlight_mps).norm(), 1e-6);
}

// Velocities along beams of echoes that no surface sends directly.

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
  const Frame frame = FrameBy(Simulator(world, pattern, materials, spec, 0));
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
      FrameBy(Simulator(WorldWithWallAt(10.0, {6.0, 0.0, 0.0}), pattern, materials, spec, 1));
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
