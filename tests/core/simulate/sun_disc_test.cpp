#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>

#include "core/base/units.h"
#include "railcast/effects.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// What hides the sun. It is 2 deg to the left of the vehicle's axis; behind all stands a wall with
// a hole through which its whole disc is seen.

constexpr double kSunAzimuth_deg = 2.0;
constexpr double kDiscRadius_deg = 0.2665;
constexpr double kHoleRadius_deg = 0.3;
constexpr double kResolution_deg = 0.1;
constexpr double kHider_m = 20.0;

/// What the beams meet, and where the sun is.
struct SunScene {
  double elevation_deg = 3.0;
  /// How far the edge of a thing 20 m ahead, which hides all to the right of it, is to the left of
  /// the sun's centre at first, in radii of the disc.
  double edge = -100.0;
  double edge_mps = 0.0;     ///< To the left.
  double vehicle_mps = 0.0;  ///< Ahead; then there is no wall.
  double turned_deg = 0.0;   ///< The whole scene about the vertical.
  bool is_wire = false;
};

double Offset_m(double distance_m, double angle_deg) {
  return distance_m * std::tan(RadFromDeg(angle_deg));
}

Part Rectangle(double x_m, double right_m, double left_m, double low_m, double high_m) {
  const auto at = [&](double y_m, double z_m) {
    return Eigen::Vector3f(static_cast<float>(x_m), static_cast<float>(y_m),
                           static_cast<float>(z_m));
  };
  return {{{at(right_m, low_m), at(left_m, low_m), at(left_m, high_m), at(right_m, high_m)},
           {{0, 1, 2}, {0, 2, 3}}},
          2,
          1};
}

double Edge_m(const SunScene& scene) {
  return Offset_m(kHider_m, kSunAzimuth_deg + scene.edge * kDiscRadius_deg);
}

/// By now, in radii of the disc.
double EdgeAt(const SunScene& scene, double time_s) {
  const double y_m = Edge_m(scene) + scene.edge_mps * time_s;
  const double ahead_m = kHider_m - scene.vehicle_mps * time_s;
  return (DegFromRad(std::atan2(y_m, ahead_m)) - kSunAzimuth_deg) / kDiscRadius_deg;
}

std::shared_ptr<SimpleWorld> WorldOf(const SunScene& scene) {
  constexpr double kWall_m = 60.0;
  constexpr double kFar_m = 40.0;
  auto world = WorldOfParts({});
  if (scene.vehicle_mps == 0.0) {
    const double up_m =
        Offset_m(kWall_m, scene.elevation_deg) / std::cos(RadFromDeg(kSunAzimuth_deg));
    const double hole_m = Offset_m(kWall_m, kHoleRadius_deg);
    const double y_m = Offset_m(kWall_m, kSunAzimuth_deg);
    world->ground.parts = {Rectangle(kWall_m, -kFar_m, y_m - hole_m, -kFar_m, kFar_m),
                           Rectangle(kWall_m, y_m + hole_m, kFar_m, -kFar_m, kFar_m),
                           Rectangle(kWall_m, -kFar_m, kFar_m, -kFar_m, up_m - hole_m),
                           Rectangle(kWall_m, -kFar_m, kFar_m, up_m + hole_m, kFar_m)};
  }
  Part hider = Rectangle(kHider_m, -kFar_m, Edge_m(scene), -kFar_m, kFar_m);
  hider.is_wire = scene.is_wire;
  if (scene.edge_mps == 0.0) {
    world->ground.parts.push_back(hider);
  } else {
    world->AddObject(std::make_shared<Model>(Model{"hider", {hider}}), Transform::Identity(),
                     {0.0, scene.edge_mps, 0.0});
  }
  world->world_from_chunk.linear() =
      RotationFromYawPitchRoll(RadFromDeg(scene.turned_deg), 0.0, 0.0);
  world->velocity_chunk_mps = {scene.vehicle_mps, 0.0, 0.0};
  return world;
}

Frame ScanSun(const SunScene& scene, int num_threads = 0) {
  SimulatorSpec spec{.detector = {.effects = {.detection = true, .sunlight = true}}};
  spec.detector.weather.sun = {.illuminance_klx = 100.0,
                               .azimuth_deg = scene.turned_deg + kSunAzimuth_deg,
                               .elevation_deg = scene.elevation_deg};
  return ScanOnce(WorldOf(scene), MakeRaster(8.0, 10.0, kResolution_deg), spec, 0, num_threads);
}

/// The visible share of a disc of which all to one side of a chord is hidden.
/// @param edge Of the chord from the centre, in radii, away from what is hidden.
double VisibleShare(double edge) {
  if (std::abs(edge) >= 1.0) return edge < 0.0 ? 1.0 : 0.0;
  return (std::acos(edge) - edge * std::sqrt(1.0 - edge * edge)) / std::numbers::pi;
}

/// The angle between a slot's beam and the sun.
double FromSun_deg(const SunScene& scene, const Frame& frame, std::size_t slot) {
  const auto direction = [](double azimuth_deg, double elevation_deg) {
    const double a = RadFromDeg(azimuth_deg);
    const double e = RadFromDeg(elevation_deg);
    return Vector3(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
  };
  const Vector3 beam = direction(3.95 - kResolution_deg * static_cast<double>(frame.column[slot]),
                                 -4.95 + kResolution_deg * static_cast<double>(frame.ring[slot]));
  const double cosine = beam.dot(direction(kSunAzimuth_deg, scene.elevation_deg));
  return DegFromRad(std::acos(std::min(1.0, cosine)));
}

constexpr double kShareError = 0.105;  // Of what rays to 16 points of the disc tell.
constexpr double kSkipped_deg = std::numbers::sqrt2 * kHoleRadius_deg + 0.01;

/// Expects the beams that meet something to be blind exactly where they are within
/// sqrt(visible share) degrees of the sun, and returns how many are blind.
/// @param share_at The visible share by the time in the frame.
template <typename ShareAt>
std::size_t ExpectBlind(const SunScene& scene, const Frame& frame, const ShareAt& share_at) {
  std::size_t num_blind = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const bool is_blind = frame.outcome[slot] == Outcome::kBelowThreshold;
    if (!is_blind && frame.outcome[slot] != Outcome::kReturned) continue;
    const double angle_deg = FromSun_deg(scene, frame, slot);
    if (angle_deg < kSkipped_deg) continue;  // It may lead through the hole.
    num_blind += is_blind ? 1 : 0;
    const double share = share_at(SecondsFromNs(frame.time_ns[slot]));
    const double error = share > 0.0 && share < 1.0 ? kShareError : 0.0;
    if (angle_deg < std::sqrt(std::max(0.0, share - error)) - 0.01) {
      EXPECT_TRUE(is_blind) << angle_deg;
    }
    if (angle_deg > std::sqrt(share + error) + 0.01) {
      EXPECT_FALSE(is_blind) << angle_deg;
    }
  }
  return num_blind;
}

TEST(SunDisc, BlindsBeamsBesideItAsFarAsItsVisiblePartAllows) {
  for (const double edge : {-2.0, -0.6, 0.0, 0.6, 2.0}) {
    for (const double turned_deg : {0.0, 137.0}) {
      SCOPED_TRACE(edge);
      const SunScene scene{.edge = edge, .turned_deg = turned_deg};
      const double share = VisibleShare(edge);
      const std::size_t num_blind =
          ExpectBlind(scene, ScanSun(scene), [&](double) { return share; });
      // Those of a circle of share * pi square degrees that are not in the middle of it.
      const double area_deg2 =
          std::max(0.0, share - kSkipped_deg * kSkipped_deg) * std::numbers::pi;
      const double error_deg2 = share > 0.0 && share < 1.0 ? kShareError * std::numbers::pi : 0.0;
      EXPECT_NEAR(static_cast<double>(num_blind), 100.0 * area_deg2, 15.0 + 100.0 * error_deg2);
    }
  }
}

// Columns are fired from left to right in 0.1 s, those towards the sun after a quarter of it.
TEST(SunDisc, IsSeenAsItIsWhenABeamIsFired) {
  struct Motion {
    double edge, edge_mps, vehicle_mps;
    bool blinds;
  };
  for (const Motion& motion : {Motion{-3.0, 6.0, 0.0, true}, Motion{3.0, -6.0, 0.0, false},
                               Motion{-0.8, 0.0, 200.0, false}, Motion{-3.0, 0.0, 40.0, true}}) {
    SCOPED_TRACE(motion.edge);
    const SunScene scene{
        .edge = motion.edge, .edge_mps = motion.edge_mps, .vehicle_mps = motion.vehicle_mps};
    const Frame frame = ScanSun(scene);
    const std::size_t num_blind = ExpectBlind(
        scene, frame, [&](double time_s) { return VisibleShare(EdgeAt(scene, time_s)); });
    EXPECT_EQ(num_blind > 0, motion.blinds);
    EXPECT_EQ(FrameBytes(frame), FrameBytes(ScanSun(scene, 1)));
  }
}

// In float32, the product of the unit vectors along a beam and to the sun may be above 1.
TEST(SunDisc, BlindsNoBeamStraightAtItWhereItIsHidden) {
  for (int i = 0; i < 24; ++i) {
    SCOPED_TRACE(i);
    const auto world = WorldOfParts({Rectangle(kHider_m, -1.0, 1.0, -1.0, 1.0)});
    world->chunk_from_vehicle.linear() =
        RotationFromYawPitchRoll(RadFromDeg(15.1 * i), RadFromDeg(1.3 * (i % 7) - 6.0), 0.0);
    for (Eigen::Vector3f& vertex : world->ground.parts[0].mesh.vertices) {
      vertex = world->chunk_from_vehicle.linear().cast<float>() * vertex;
    }
    const Vector3 ahead = world->chunk_from_vehicle.linear() * Vector3::UnitX();
    SimulatorSpec spec{.detector = {.effects = {.detection = true, .sunlight = true}}};
    spec.detector.weather.sun = {.illuminance_klx = 100.0,
                                 .azimuth_deg = DegFromRad(std::atan2(ahead.y(), ahead.x())),
                                 .elevation_deg = DegFromRad(std::asin(ahead.z()))};
    // The nearest beams are 0.007 deg off.
    const Frame frame = ScanOnce(world, MakeRaster(0.04, 0.04, 0.01), spec);
    EXPECT_EQ(std::ranges::count(frame.outcome, Outcome::kReturned), 16);
  }
}

TEST(SunDisc, IsHiddenBelowTheHorizonAndByNoWire) {
  const auto num_blind = [](const SunScene& scene, double share) {
    return ExpectBlind(scene, ScanSun(scene), [&](double) { return share; });
  };
  EXPECT_EQ(num_blind({.elevation_deg = -0.5}, 0.0), 0U);
  EXPECT_GT(num_blind({.elevation_deg = 0.0}, 0.5), 50U);
  EXPECT_GT(num_blind({.edge = 100.0, .is_wire = true}, 1.0), 200U);
}

}  // namespace
}  // namespace railcast
