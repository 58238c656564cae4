// Velocities along beams of what turns, bends and sways, and of the sensor, against their motion.
#include "core/simulate/velocity_meter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/detect/base/wind_velocity.h"
#include "core/simulate/wind.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/core/simulate/measured_velocities.h"
#include "tests/core/simulate/turning_leaf.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

TEST(VelocityOfThings, OfWhatTurnsIsThatOfThePointThatIsHit) {
  const ScanPattern pattern = MakeRaster(10, 5, 0.5);
  const Frame frame = ScanOnce(std::make_shared<TurningLeaf>(), pattern, Measuring());
  double fastest_mps = 0.0;
  ForEachFiring(frame, pattern, [&](std::size_t slot, const Vector3& direction, double) {
    ASSERT_EQ(frame.instance[slot], 1U);
    const Vector3 place_m = static_cast<double>(frame.true_range_m[slot]) * direction;
    const Vector3 arm_m = place_m - Vector3(20.0, 0.0, 0.0);
    const double expected_mps =
        direction.dot(TurningLeaf::kTurn_radps * Vector3::UnitZ().cross(arm_m));
    EXPECT_NEAR(TrueAt(frame, slot), expected_mps, 1e-3);
    fastest_mps = std::max(fastest_mps, std::abs(expected_mps));
  });
  EXPECT_GT(fastest_mps, 4.0);
}

/// A shipped scenario without weather, seen by exact beams with velocities.
ScenarioSpec ShippedScene(const std::string& name) {
  ScenarioSpec spec = ReadScenario(ScenariosDir() / name);
  spec.fidelity = Fidelity::kGeometry;
  spec.effects.clear();
  spec.weather = {};
  spec.lidar.scan.pattern = RasterSpec{60.0, 30.0, 1.0};
  spec.lidar.velocity = kExact;
  return spec;
}

// The vehicle's motion has its derivatives from the track itself: chainage, curvature, cant, ride.
TEST(VelocityOfThings, OfGroundIsTheVehiclesMotionInACurveWithCantAndRide) {
  ScenarioSpec spec = ShippedScene("st_gallen_approach.json");
  spec.vehicle.ride = RideSpec{};
  spec.vehicle.motion.profile = {SpeedPoint{0.0, {}, 30.0}};
  const auto simulator = MakeSimulator(spec, 0);
  const auto world = MakeWorld(spec);
  const Transform vehicle_from_sensor = VehicleFromSensor(spec.lidar.mount);
  const Frame frame = FrameBy(*simulator, 3);
  double fastest_turn_radps = 0.0;
  std::size_t num_grounds = 0;
  ForEachFiring(
      frame, simulator->pattern(), [&](std::size_t slot, const Vector3& direction, double) {
        if (frame.instance[slot] != 0 || std::isnan(frame.x[slot])) return;
        const RigidMotion vehicle = world->VehicleMotion(frame.stamp_ns + frame.time_ns[slot]);
        const Vector3 origin_mps = vehicle.VelocityOf_mps(vehicle_from_sensor.translation());
        const Vector3 beam =
            vehicle.world_from_body.linear() * (vehicle_from_sensor.linear() * direction);
        EXPECT_NEAR(TrueAt(frame, slot), -beam.dot(origin_mps), 1e-3) << slot;
        fastest_turn_radps = std::max(fastest_turn_radps, vehicle.angular_velocity_radps.norm());
        ++num_grounds;
      });
  EXPECT_GT(num_grounds, 500U);
  EXPECT_GT(fastest_turn_radps, 5e-3) << "there is a curve, or the body rolls";
}

/// The velocities that the pieces of an object would give a point, along a direction.
std::vector<double> RatesOfPieces_mps(const World& world,
                                      std::size_t object,
                                      std::int64_t time_ns,
                                      const Vector3& place_m,
                                      const Vector3& direction) {
  constexpr std::int64_t kApart_ns = 100'000;
  const auto before = world.WorldFromPieces(object, time_ns - kApart_ns);
  const auto now = world.WorldFromPieces(object, time_ns);
  const auto after = world.WorldFromPieces(object, time_ns + kApart_ns);
  std::vector<double> rates_mps;
  for (std::size_t piece = 0; piece < now.size(); ++piece) {
    const Vector3 in_piece_m = now[piece].inverse() * place_m;
    const Vector3 change_m = after[piece] * in_piece_m - before[piece] * in_piece_m;
    rates_mps.push_back(direction.dot(change_m) / SecondsFromNs(2 * kApart_ns));
  }
  return rates_mps;
}

// Limbs swing: the rates of a person's pieces differ by metres per second, and one of them must be
// that of the point.
TEST(VelocityOfThings, OfPersonsIsThatOfTheLimbThatIsHit) {
  ScenarioSpec spec = ShippedScene("situations/person_crossing.json");
  spec.lidar.scan.pattern = RasterSpec{30.0, 20.0, 0.1};
  const auto simulator = MakeSimulator(spec, 0);
  const World& world = simulator->world();
  Frame frame;
  std::size_t num_points = 0;
  double widest_mps = 0.0;
  for (const std::uint32_t index : {200U, 215U, 230U}) {
    simulator->Scan(index, frame);
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      const std::uint32_t instance = frame.instance[slot];
      if ((instance != 1 && instance != 2) || std::isnan(frame.x[slot])) continue;
      const std::int64_t time_ns = frame.stamp_ns + frame.time_ns[slot];
      const Transform world_from_sensor = simulator->WorldFromSensor(time_ns);
      const Vector3 direction =
          world_from_sensor.linear() *
          DirectionOf(simulator->pattern(), FiringOfSlot(simulator->pattern(), 1, slot));
      const Vector3 place_m = world_from_sensor.translation() +
                              static_cast<double>(frame.true_range_m[slot]) * direction;
      const Vector3 sensor_mps = (simulator->WorldFromSensor(time_ns + 100'000).translation() -
                                  simulator->WorldFromSensor(time_ns - 100'000).translation()) /
                                 2e-4;
      const std::vector<double> rates_mps =
          RatesOfPieces_mps(world, instance - 1, time_ns, place_m, direction);
      double off_mps = std::numeric_limits<double>::infinity();
      for (const double rate_mps : rates_mps) {
        off_mps = std::min(off_mps,
                           std::abs(TrueAt(frame, slot) - (rate_mps - direction.dot(sensor_mps))));
      }
      // Linear between poses 10 ms apart: dt^2 / 8 of the jerk of a foot, 1000 m/s^3.
      EXPECT_LT(off_mps, 0.0125) << index << " " << slot;
      const auto [least, most] = std::ranges::minmax(rates_mps);
      widest_mps = std::max(widest_mps, most - least);
      ++num_points;
    }
  }
  EXPECT_GT(num_points, 50U);
  EXPECT_GT(widest_mps, 0.2);
}

// Both trees are placements of one model, so that the window has one surface for them.
TEST(VelocityOfThings, TellsTreesApartThatShareTheirModel) {
  auto world = std::make_shared<SimpleWorld>();
  const auto tree = std::make_shared<Model>(Model{"tree", {{MakeWall(0.0F, 5.0F), 2, 21}}});
  constexpr double kHeight_m = 10.0;
  std::vector<TreeInWind> trees;
  for (const double y_m : {-6.0, 6.0}) {
    const Vector3 foot_m(20.0, y_m, 0.0);
    world->placements.push_back(
        {tree, Eigen::Affine3d(Eigen::Translation3d(foot_m)), 0, kHeight_m});
    trees.push_back({foot_m, kHeight_m, 0, static_cast<std::uint32_t>(trees.size() + 1)});
  }
  SimulatorSpec spec = Measuring();
  spec.detector.weather.wind_speed_mps = 20.0;
  spec.detector.weather.wind_direction_deg = 170.0;
  const Wind wind(WindVelocity_mps(spec.detector.weather), spec.detector.air_seed);
  const auto turn_at = [&](const TreeInWind& in_wind, double time_s) {
    const Vector3 tip_m = TreeTip_m(wind, in_wind, time_s);
    return Eigen::AngleAxisd(tip_m.norm() / kHeight_m, Vector3::UnitZ().cross(tip_m).normalized())
        .toRotationMatrix();
  };
  const ScanPattern pattern = MakeRaster(50, 24, 1);
  double greatest_off_mps = 0.0;
  double fastest_mps = 0.0;
  for (const std::uint32_t index : {3U, 11U, 20U}) {
    const Frame frame = ScanOnce(world, pattern, spec, index);
    ForEachFiring(frame, pattern, [&](std::size_t slot, const Vector3& direction, double time_s) {
      if (std::isnan(frame.x[slot])) return;
      const Vector3 place_m = static_cast<double>(frame.true_range_m[slot]) * direction;
      const TreeInWind& hit = trees[place_m.y() > 0.0 ? 1 : 0];
      const Vector3 in_tree_m = turn_at(hit, time_s).transpose() * (place_m - hit.foot_world_m);
      const Vector3 change_m =
          turn_at(hit, time_s + 1e-4) * in_tree_m - turn_at(hit, time_s - 1e-4) * in_tree_m;
      const double expected_mps = direction.dot(change_m) / 2e-4;
      greatest_off_mps = std::max(greatest_off_mps, std::abs(TrueAt(frame, slot) - expected_mps));
      fastest_mps = std::max(fastest_mps, std::abs(expected_mps));
    });
  }
  EXPECT_GT(fastest_mps, 0.02);
  // Linear over 0.1 s: (2 pi 0.76 Hz 0.1 s)^2 / 8 = 3 %; of several waves, their sum.
  EXPECT_LT(greatest_off_mps, 0.06 * fastest_mps);
}

}  // namespace
}  // namespace railcast
