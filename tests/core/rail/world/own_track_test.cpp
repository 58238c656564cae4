#include "core/rail/world/own_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/core/rail/world/made_track.h"

namespace railcast {
namespace {

const Vector3 kPerson_m(0.5, 0.6, 1.8);
const Vector3 kWagon_m(20.0, 3.0, 4.0);

/// A box standing at rail level, at a position and heading in the plane.
Transform BoxAt(double x_m, double y_m, const Vector3& size_m, double heading_rad = 0.0) {
  return MakeTransform(RotationFromYawPitchRoll(heading_rad, 0.0, 0.0),
                       Vector3(x_m, y_m, 0.5 * size_m.z()));
}

Transform VehicleAt(double x_m, double heading_rad = 0.0) {
  return MakeTransform(RotationFromYawPitchRoll(heading_rad, 0.0, 0.0), Vector3(x_m, 0.0, 0.0));
}

bool IsInWay(double x_m, double y_m, double heading_rad = 0.0) {
  return StraightTrack()
      .ClearanceAhead(VehicleAt(500.0, heading_rad), BoxAt(x_m, y_m, kPerson_m), kPerson_m)
      .is_inside;
}

TEST(OwnTrack, HasInItsWayWhatReachesIntoTheGaugeAhead) {
  EXPECT_TRUE(IsInWay(600.0, 0.0));
  EXPECT_TRUE(IsInWay(600.0, 1.574 + 0.3));
  EXPECT_FALSE(IsInWay(600.0, 1.576 + 0.3));
  EXPECT_FALSE(IsInWay(600.0, 4.0)) << "on the second track";
  EXPECT_NEAR(StraightTrack()
                  .ClearanceAhead(VehicleAt(500.0), BoxAt(600.0, -2.4, kPerson_m), kPerson_m)
                  .from_axis_m,
              2.1, 1e-9);
}

TEST(OwnTrack, IsTheWayThatTheVehicleGoes) {
  EXPECT_FALSE(IsInWay(400.0, 0.0)) << "behind";
  EXPECT_TRUE(IsInWay(400.0, 0.0, std::numbers::pi)) << "in reverse";
  EXPECT_FALSE(IsInWay(600.0, 0.0, std::numbers::pi));
  EXPECT_FALSE(IsInWay(2'010.0, 0.0)) << "beyond the track's end";
}

// At 300 m along a curve of 300 m radius the track lies 138 m to the left of the tangent.
TEST(OwnTrack, FollowsTheCurve) {
  constexpr double kRadius_m = 300.0;
  const OwnTrack track = OwnTrackOf(ScenarioOn(ElementType::kArc, 800.0, kRadius_m));
  const auto at = [&](double s_m, double d_m, const Vector3& size_m) {
    const double angle_rad = s_m / kRadius_m;
    const double radius_m = kRadius_m - d_m;
    return track.ClearanceAhead(
        VehicleAt(0.0),
        BoxAt(radius_m * std::sin(angle_rad), kRadius_m - radius_m * std::cos(angle_rad), size_m,
              angle_rad),
        size_m);
  };
  EXPECT_TRUE(at(300.0, 0.0, kPerson_m).is_inside);
  EXPECT_NEAR(at(300.0, 3.0, kPerson_m).from_axis_m, 2.7, 0.01);
  const auto straight_ahead =
      track.ClearanceAhead(VehicleAt(0.0), BoxAt(280.0, 0.0, kPerson_m), kPerson_m);
  EXPECT_FALSE(straight_ahead.is_inside);
  // The ends of a wagon are 10^2 / (2 R) = 0.17 m farther out than its middle, so they are nearer
  // to the axis if it stands inside the curve.
  const GaugeClearance inside = at(300.0, 4.0, kWagon_m);
  EXPECT_FALSE(inside.is_inside);
  EXPECT_NEAR(inside.from_axis_m, 4.0 - 1.5 - 0.167, 0.01);
  EXPECT_NEAR(at(300.0, -4.0, kWagon_m).from_axis_m, 4.0 - 1.5, 0.01);
}

/// The place of a point whose chainage is found by bisection: where the cross-section of the track
/// holds it, which is between two others.
PlaceByTrack SlowPlaceOf(const OwnTrack& track,
                         const Vector3& world_m,
                         double from_s_m,
                         double to_s_m) {
  const auto seen_from = [&](double s_m) -> Vector3 {
    return track.WorldFromTrack(s_m).inverse() * world_m;
  };
  for (int i = 0; i < 60; ++i) {
    const double middle_s_m = 0.5 * (from_s_m + to_s_m);
    (seen_from(middle_s_m).x() > 0.0 ? from_s_m : to_s_m) = middle_s_m;
  }
  const Vector3 place_m = seen_from(from_s_m);
  return {from_s_m, place_m.y(), place_m.z()};
}

constexpr double kExactPlace_m = 1e-3;
/// Between two points of the axis, headings are taken to change evenly. Where the curvature jumps
/// by k half-way between them, they err by k h / 4.
constexpr double kMostTurnError_rad = 1.0 / 190.0 / 4.0;

/// Points near a track, from `from_s_m` to `to_s_m`, are where a slow search finds them.
void ExpectPlacesAsFoundSlowly(const OwnTrack& track, double from_s_m, double to_s_m) {
  std::minstd_rand random(7);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  double near_s_m = from_s_m;
  for (int i = 0; i < 500; ++i) {
    const double s_m = between(from_s_m, to_s_m);
    const double reach_m = i % 2 == 0 ? 3.0 : 80.0;
    const Vector3 world_m =
        track.WorldFromTrack(s_m) * Vector3(0.0, between(-reach_m, reach_m), between(-1.0, 8.0));
    const auto place = track.PlaceOf(world_m, near_s_m);
    ASSERT_TRUE(place.has_value());
    const PlaceByTrack slow = SlowPlaceOf(track, world_m, s_m - 5.0, s_m + 5.0);
    ASSERT_NEAR(place->chainage_m, slow.chainage_m,
                kExactPlace_m + kMostTurnError_rad * std::abs(slow.lateral_m));
    ASSERT_NEAR(place->lateral_m, slow.lateral_m, kExactPlace_m);
    ASSERT_NEAR(place->height_m, slow.height_m, kExactPlace_m);
    near_s_m = place->chainage_m;
  }
}

TEST(OwnTrack, PutsPointsInItsAxesOnTheStraight) {
  const auto place = StraightTrack().PlaceOf(Vector3(812.3, -1.25, 0.75), 0.0);
  ASSERT_TRUE(place.has_value());
  EXPECT_NEAR(place->chainage_m, 812.3, 1e-9);
  EXPECT_NEAR(place->lateral_m, -1.25, 1e-9);
  EXPECT_NEAR(place->height_m, 0.75, 1e-9);
}

// On a circle the chainage is R times the angle, and the lateral position R less the distance from
// the centre.
TEST(OwnTrack, PutsPointsInItsAxesOnACircleInClosedForm) {
  constexpr double kRadius_m = 300.0;
  const OwnTrack track = OwnTrackOf(ScenarioOn(ElementType::kArc, 800.0, kRadius_m));
  for (const double d_m : {-200.0, -1.4, 0.0, 1.6, 100.0, 200.0}) {
    for (const double s_m : {0.25, 100.5, 333.3, 799.9}) {
      const double angle_rad = s_m / kRadius_m;
      const Vector3 world_m((kRadius_m - d_m) * std::sin(angle_rad),
                            kRadius_m - (kRadius_m - d_m) * std::cos(angle_rad), 2.0);
      const auto place = track.PlaceOf(world_m, 400.0);
      ASSERT_TRUE(place.has_value());
      EXPECT_NEAR(place->chainage_m, s_m, 1e-3);
      EXPECT_NEAR(place->lateral_m, d_m, 1e-3);
      EXPECT_NEAR(place->height_m, 2.0, 1e-9);
    }
  }
}

TEST(OwnTrack, FollowsCantGradientAndItsBreaks) {
  ScenarioSpec scenario = ScenarioOn(ElementType::kStraight, 0.0);
  scenario.world.alignment.course = AlignmentElementsSpec{{{ElementType::kStraight, 150.0, {}},
                                                           {ElementType::kClothoid, 60.0, {}},
                                                           {ElementType::kArc, 300.0, -350.0},
                                                           {ElementType::kClothoid, 60.0, {}},
                                                           {ElementType::kStraight, 150.0, {}}}};
  scenario.world.alignment.gradients_permil = {{0.0, 20.0}, {300.0, -25.0}};
  scenario.world.alignment.cants_mm = {
      {0.0, 0.0}, {150.0, 0.0}, {210.0, -150.0}, {510.0, -150.0}, {570.0, 0.0}};
  ExpectPlacesAsFoundSlowly(OwnTrackOf(scenario), 10.0, 700.0);
}

TEST(OwnTrack, FollowsTheRouteThroughTurnouts) {
  ScenarioSpec scenario = ScenarioOn(ElementType::kStraight, 1'000.0);
  scenario.world.tracks = {TrackSpec()};
  scenario.world.tracks.front().name = "main";
  scenario.world.tracks.push_back({.name = "loop",
                                   .offset_m = 4.5,
                                   .begin = TurnoutSpec{"main", 300.0, TurnoutType::k9_190, {}, {}},
                                   .end = TurnoutSpec{"main", 700.0, TurnoutType::k9_300, {}, {}}});
  scenario.vehicle.route = {"main", "loop", "main"};
  const OwnTrack track = OwnTrackOf(scenario);
  ExpectPlacesAsFoundSlowly(track, 10.0, 990.0);
  const auto place = track.PlaceOf(Vector3(500.0, 4.5, 1.0), 0.0);
  ASSERT_TRUE(place.has_value());
  EXPECT_NEAR(place->lateral_m, 0.0, 1e-9) << "the middle of the loop";
}

TEST(OwnTrack, HasNoPlaceForPointsBeyondItsEnds) {
  EXPECT_FALSE(StraightTrack().PlaceOf(Vector3(-0.1, 0.0, 0.0), 0.0).has_value());
  EXPECT_TRUE(StraightTrack().PlaceOf(Vector3(0.1, 0.0, 0.0), 0.0).has_value());
  EXPECT_TRUE(StraightTrack().PlaceOf(Vector3(1'999.9, 0.0, 0.0), 0.0).has_value());
  EXPECT_FALSE(StraightTrack().PlaceOf(Vector3(2'000.1, 0.0, 0.0), 0.0).has_value());
}

TEST(OwnTrack, FindsTheSamePlaceWhereverTheSearchBegins) {
  const OwnTrack track = OwnTrackOf(ScenarioOn(ElementType::kArc, 1'500.0, 300.0));
  const Vector3 world_m = track.WorldFromTrack(412.3) * Vector3(0.0, 60.0, 1.0);
  const auto place = track.PlaceOf(world_m, 412.0);
  ASSERT_TRUE(place.has_value());
  for (double near_s_m = -50.0; near_s_m < 1'600.0; near_s_m += 25.0) {
    const auto same = track.PlaceOf(world_m, near_s_m);
    ASSERT_TRUE(same.has_value());
    EXPECT_EQ(same->chainage_m, place->chainage_m) << near_s_m;
  }
}

TEST(OwnTrack, HasPointsInTheGaugeInsideItsOutlineOnly) {
  const auto is_in_gauge = [](double lateral_m, double height_m) {
    return StraightTrack().IsInGauge({500.0, lateral_m, height_m});
  };
  EXPECT_TRUE(is_in_gauge(0.0, 0.01));
  EXPECT_FALSE(is_in_gauge(0.0, -0.01)) << "below top of rail";
  EXPECT_TRUE(is_in_gauge(-1.574, 1.0));
  EXPECT_FALSE(is_in_gauge(-1.576, 1.0));
  EXPECT_TRUE(is_in_gauge(1.0, 4.27));
  EXPECT_FALSE(is_in_gauge(0.0, 5.21)) << "above that of the pantograph";
}

}  // namespace
}  // namespace railcast
