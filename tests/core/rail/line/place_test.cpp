#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rail/line/line_place.h"
#include "core/rail/line/map_place.h"
#include "tests/core/rail/test_line.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

TEST(PlaceOnLine, FindsWhereAPlaceBesideTheLineLies) {
  WorldSpec spec = CantedArc(600.0, 300.0);
  spec.alignment.speed_limits_kmph.clear();
  spec.alignment.gradients_permil = {{0.0, 12.0}};
  const Alignment alignment(spec.alignment);
  for (const double d_m : {-150.0, -4.0, 0.0, 80.0}) {
    const AxisPoint axis = alignment.At(317.0);
    const Vector3 left(-std::sin(axis.heading_rad), std::cos(axis.heading_rad), 0.0);
    const Vector3 place_m = axis.position_m + d_m * left + Vector3(0.0, 0.0, 5.5);
    const PlaceBesideLine found = PlaceOnLine(alignment, place_m, 290.0);
    // Its last step is below 1 um.
    EXPECT_NEAR(found.s_m, 317.0, 1e-6) << d_m;
    EXPECT_NEAR(found.d_m, d_m, 1e-6) << d_m;
    EXPECT_NEAR(found.h_m, 5.5, 1e-6) << d_m;
  }
}

Eigen::Vector2d InPlan(const Alignment& alignment, double s_m, double d_m) {
  return alignment.WorldFromTrack(s_m, d_m).translation().head<2>();
}

/// Two straights of 500 m side by side with 200 m between them, joined by half a circle.
Alignment TwoLegs() {
  AlignmentSpec spec = AlignmentOf({{ElementType::kStraight, 500.0, {}},
                                    {ElementType::kArc, 100.0 * std::numbers::pi, 100.0},
                                    {ElementType::kStraight, 500.0, {}}});
  spec.curvature_smoothing_m = 1e-3;
  return Alignment(spec);
}

TEST(NearestOnLine, FindsTheLegOfAHairpinBesideWhichAPlaceLies) {
  const Alignment line = TwoLegs();
  const double length_m = line.length_m();
  for (const double s_m : {0.0, 3.0, 250.0, 499.0, 600.0, 700.0, length_m - 250.0, length_m}) {
    for (const double d_m : {-400.0, -70.0, 0.0, 70.0}) {
      const auto found = NearestOnLine(line, InPlan(line, s_m, d_m));
      ASSERT_EQ(found.size(), 1U) << s_m << " " << d_m;
      EXPECT_NEAR(found.front().s_m, s_m, 1e-5) << d_m;
      EXPECT_NEAR(found.front().d_m, d_m, 1e-5) << s_m;
    }
  }
}

TEST(NearestOnLine, SaysAboutHowFarAwayAPlaceIs) {
  const Alignment line = TwoLegs();
  for (const Eigen::Vector2d& place_m :
       {Eigen::Vector2d(-3e6, 1e6), Eigen::Vector2d(500.0, -9e7), Eigen::Vector2d(9e3, 100.0)}) {
    double least_m = 1e9;
    for (double s_m = 0.0; s_m <= line.length_m(); s_m += 1.0) {
      least_m = std::min(least_m, (line.At(s_m).position_m.head<2>() - place_m).norm());
    }
    const auto found = NearestOnLine(line, place_m);
    ASSERT_EQ(found.size(), 1U);
    // Candidates may be 5 m farther away, and places between two steps a hundred-thousandth.
    EXPECT_NEAR(found.front().d_m, least_m, 6.0 + 2e-5 * least_m);
  }
}

TEST(NearestOnLine, SaysThatAPlaceMidwayBetweenTwoLegsIsBesideBoth) {
  const Alignment line = TwoLegs();
  const auto found = NearestOnLine(line, InPlan(line, 200.0, 100.0));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found.front().s_m, 200.0, 1e-3);
  EXPECT_NEAR(found.back().s_m, line.length_m() - 200.0, 1e-3);
}

TEST(NearestOnLine, SaysThatTheCentreOfAnArcIsBesideAllOfIt) {
  const Alignment line = TwoLegs();
  EXPECT_GT(NearestOnLine(line, InPlan(line, 600.0, 100.0)).size(), 2U);
}

TEST(NearestOnLine, GoesStraightOnBeyondTheEnds) {
  const Alignment line(CantedArc(400.0, 300.0).alignment);
  for (const double s_m : {-30.0, 430.0}) {
    const auto found = NearestOnLine(line, InPlan(line, s_m, -6.0));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found.front().s_m, s_m, 1e-5);
    EXPECT_NEAR(found.front().d_m, -6.0, 1e-5);
  }
}

TEST(PlaceOnTrack, IsTheInverseOfTheTracksFrameAlsoInATurnout) {
  WorldSpec spec = CantedArc(600.0, 400.0);
  TrackSpec branch{.name = "branch",
                   .begin = TurnoutSpec{"main", 100.0, TurnoutType::k9_300, {}, {}}};
  branch.offset_m = -4.5;
  spec.tracks.push_back(branch);
  const TestLine line(spec);
  const TrackCourse& course = line.network().courses.at(1);
  for (const double s_m : {100.0, 112.0, 127.0, 140.0, 170.0, 300.0}) {
    for (const double d_m : {-30.0, -1.0, 0.0, 2.0, 40.0}) {
      const Eigen::Vector2d place_m =
          course.WorldFromTrack(line.alignment(), s_m, d_m).translation().head<2>();
      const double near_s_m = NearestOnLine(line.alignment(), place_m).front().s_m;
      const PlaceBesideTrack found = PlaceOnTrack(line.alignment(), course, place_m, near_s_m);
      EXPECT_NEAR(found.s_m, s_m, 1e-5) << d_m;
      EXPECT_NEAR(found.d_m, d_m, 1e-5) << s_m;
    }
  }
}

// What PROJ 9.1.1 makes of "+proj=tmerc +lat_0=... +lon_0=... +k=1 +x_0=0 +y_0=0 +ellps=WGS84", to
// 1 um.
struct ProjPlace {
  double middle_longitude_deg{};
  double middle_latitude_deg{};
  double longitude_deg{};
  double latitude_deg{};
  double easting_m{};
  double northing_m{};
};
constexpr ProjPlace kProjPlaces[] = {
    {15.63, 48.21, 15.63, 48.21, 0.0, 0.0},
    {15.63, 48.21, 15.4931, 48.1207, -10192.356780, -9920.516834},
    {15.63, 48.21, 15.7612, 48.2955, 9734.801869, 9515.514008},
    {15.63, 48.21, 18.63, 47.0, 228160.829396, -130160.496923},
    {-70.5, -33.4, -70.61234, -33.45678, -10444.105875, -6303.234080},
    {10.75, 59.9, 11.75, 60.4, 55123.598497, 56125.695964},
    {179.9, -17.5, -179.9, -17.6, 21228.272794, -11078.734004},
    {0.0, 0.0, 0.5, -0.5, 55658.351326, -55289.271330}};

TEST(WorldFromGeographic, IsTheTransverseMercatorOfProj) {
  // Half of the last digit, and as much for the series.
  constexpr double kTolerance_m = 1e-6;
  for (const ProjPlace& there : kProjPlaces) {
    const MapSpec map{{0.0, 0.0}, there.middle_longitude_deg, there.middle_latitude_deg, {}};
    const Eigen::Vector2d found_m =
        WorldFromGeographic(map, there.longitude_deg, there.latitude_deg);
    EXPECT_NEAR(found_m.x(), there.easting_m, kTolerance_m) << there.longitude_deg;
    EXPECT_NEAR(found_m.y(), there.northing_m, kTolerance_m) << there.longitude_deg;
  }
}

TEST(WorldFromGeographic, SubtractsTheOrigin) {
  const MapSpec map{{100.0, -200.0}, 15.63, 48.21, {}};
  EXPECT_LT((WorldFromGeographic(map, 15.63, 48.21) - Eigen::Vector2d(-100.0, 200.0)).norm(), 1e-6);
  EXPECT_EQ(WorldFromProjection(map, {100.0, -200.0}), Eigen::Vector2d::Zero());
}

TEST(WorldFromGeographic, IsAPolynomialOfTheTransverseMercatorWithCoefficients) {
  MapSpec map{{0.0, 0.0}, 15.63, 48.21, {}};
  const Eigen::Vector2d place = WorldFromGeographic(map, 15.7612, 48.2955) / 1e5;
  map.coefficients_m = {{1.0, 2.0}, {3.0, 4.0}, {5.0, 6.0}, {7.0, 8.0}, {9.0, 10.0}, {11.0, 12.0}};
  const double e = place.x();
  const double n = place.y();
  const Eigen::Vector2d expected_m(
      1.0 + 3.0 * e + 5.0 * n + 7.0 * e * e + 9.0 * e * n + 11.0 * n * n,
      2.0 + 4.0 * e + 6.0 * n + 8.0 * e * e + 10.0 * e * n + 12.0 * n * n);
  EXPECT_LT((WorldFromGeographic(map, 15.7612, 48.2955) - expected_m).norm(), 1e-12);
}

TEST(WorldFromGeographic, EndsAQuarterOfATurnAway) {
  const MapSpec map{{0.0, 0.0}, 170.0, 0.0, {}};
  EXPECT_TRUE(WorldFromGeographic(map, -101.0, 10.0).allFinite());
  EXPECT_TRUE(std::isnan(WorldFromGeographic(map, -99.0, 10.0).x()));
}

TEST(GeographicFromWorld, LeadsBackToTheSamePlace) {
  for (const ProjPlace& there : kProjPlaces) {
    MapSpec map{{500.0, -300.0}, there.middle_longitude_deg, there.middle_latitude_deg, {}};
    for (const bool has_coefficients : {false, true}) {
      // Another projection: turned, bent and off by kilometres.
      if (has_coefficients) {
        map.coefficients_m = {{4000.0, -2000.0}, {99'000.0, 8000.0}, {-8000.0, 99'000.0},
                              {50.0, 20.0},      {10.0, -30.0},      {0.0, 40.0}};
      }
      const Eigen::Vector2d place_m =
          WorldFromGeographic(map, there.longitude_deg, there.latitude_deg);
      const Eigen::Vector2d found_deg = GeographicFromWorld(map, place_m);
      const Eigen::Vector2d back_m = WorldFromGeographic(map, found_deg.x(), found_deg.y());
      EXPECT_LT((back_m - place_m).norm(), 1e-6);
      // 1 um of ground are 1e-11 degrees of latitude.
      EXPECT_NEAR(found_deg.y(), there.latitude_deg, 2e-11);
      EXPECT_NEAR(std::remainder(found_deg.x() - there.longitude_deg, 360.0), 0.0, 4e-11);
    }
  }
}

TEST(GeographicFromWorld, IsNowhereBeyondTheMap) {
  const MapSpec map{{0.0, 0.0}, 15.63, 48.21, {}};
  EXPECT_TRUE(std::isnan(GeographicFromWorld(map, {1e9, 0.0}).x()));
}

}  // namespace
}  // namespace railcast
