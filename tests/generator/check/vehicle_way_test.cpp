#include "generator/check/check_report.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

constexpr double kLine_m = 1000.0;
// The accuracy of a time found by bisection.
constexpr double kBisection_s = 1e-6;

TrackCourse Axis() {
  return {0.0, kLine_m, 0.0};
}

VehicleSpec VehicleAt(double s_m, std::vector<SpeedPoint> profile) {
  VehicleSpec vehicle;
  vehicle.start_s_m = s_m;
  vehicle.motion.profile = std::move(profile);
  return vehicle;
}

TEST(VehicleWay, OfAVehicleThatStandsHasNoEnd) {
  const VehicleWay way = FindVehicleWay(VehicleAt(400.0, {}), Axis());
  EXPECT_EQ(way.start.s_m, 400.0);
  EXPECT_EQ(way.start.speed_mps, 0.0);
  EXPECT_FALSE(way.profile_end);
  EXPECT_FALSE(way.track_end);
}

TEST(VehicleWay, ReachesTheEndOfItsTrackAtAConstantSpeed) {
  const TrackCourse track(0.0, 700.0, 0.0);
  const VehicleWay way = FindVehicleWay(VehicleAt(400.0, {{0.0, {}, 20.0}}), track);
  EXPECT_EQ(way.profile_end->time_s, 0.0);
  EXPECT_NEAR(way.track_end->time_s, 15.0, kBisection_s);
  EXPECT_NEAR(way.track_end->s_m, 700.0, 1e-6);
  EXPECT_EQ(way.track_end->speed_mps, 20.0);
}

TEST(VehicleWay, RunsBackwardsToTheBeginOfItsTrack) {
  VehicleSpec vehicle = VehicleAt(400.0, {{0.0, {}, 20.0}});
  vehicle.motion.reverse = true;
  const TrackCourse track(100.0, kLine_m, 0.0);
  EXPECT_NEAR(FindVehicleWay(vehicle, track).track_end->time_s, 15.0, kBisection_s);
}

TEST(VehicleWay, EndsWhereItBrakesToAStop) {
  // Braking from 8 m/s to 0 over 55 m takes 2 x 55 / 8 s.
  const VehicleWay way =
      FindVehicleWay(VehicleAt(200.0, {{{}, 200.0, 8.0}, {{}, 255.0, 0.0}}), Axis());
  // The end is found kArrival_m before the stop, at a deceleration of 0.58 m/s^2.
  EXPECT_NEAR(way.profile_end->time_s, 13.75, 1e-4);
  EXPECT_NEAR(way.profile_end->s_m, 255.0, 1e-6);
  EXPECT_EQ(way.profile_end->speed_mps, 0.0);
  EXPECT_FALSE(way.track_end);
}

}  // namespace
}  // namespace railcast
