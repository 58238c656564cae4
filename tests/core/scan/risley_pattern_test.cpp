#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/core/scan/pattern_angles.h"

namespace railcast {
namespace {

constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;

/// One beam every 10 us, 1000 in a frame at 100 Hz, and as many as 100,000 in one at 1 Hz.
RisleySpec OneBeam(std::vector<PrismSpec> prisms, std::uint32_t columns = 1000) {
  return {.channels = {ChannelSpec{}},
          .cycle_us = 10.0,
          .columns = columns,
          .prisms = std::move(prisms)};
}

ScanPattern PatternOf(const RisleySpec& spec, double rate_hz = 100.0) {
  return BuildScanPattern({.rate_hz = rate_hz, .pattern = spec});
}

PrismSpec Standing(double wedge_deg, double start_deg, double refractive_index = 1.51) {
  return {.wedge_deg = wedge_deg, .refractive_index = refractive_index, .start_deg = start_deg};
}

/// Prisms that turn as those of a Livox Mid-40 (Brazeal et al. 2021, doi 10.3390/s21144722).
std::vector<PrismSpec> Turning(double wedge_deg) {
  return {{.wedge_deg = wedge_deg, .refractive_index = 1.51, .turns_hz = -4664.0 / 60.0},
          {.wedge_deg = wedge_deg, .refractive_index = 1.51, .turns_hz = 7294.0 / 60.0}};
}

std::string FaultsOf(const RisleySpec& spec) {
  return FaultsOf(ScanSpec{.rate_hz = 100.0, .pattern = spec});
}

double FromAxis_deg(const ScanPattern& pattern, std::size_t firing) {
  const Vector3 direction = Direction(pattern, firing);
  return DegFromRad(std::atan2(direction.tail<2>().norm(), direction.x()));
}

// Light meets the first face at right angles and the second at the wedge angle.
TEST(RisleyPattern, BendsABeamToThePrismsThickSideBySnellsLaw) {
  const double wedge_rad = RadFromDeg(18.0);
  const double bent_deg = DegFromRad(std::asin(1.51 * std::sin(wedge_rad)) - wedge_rad);
  const ScanPattern left = PatternOf(OneBeam({Standing(18.0, 0.0)}));
  EXPECT_NEAR(AzimuthInDegrees(left, 0), bent_deg, kFloatAngle_deg);
  EXPECT_NEAR(ElevationInDegrees(left, 0), 0.0, kFloatAngle_deg);
  const ScanPattern up = PatternOf(OneBeam({Standing(18.0, 90.0)}));
  EXPECT_NEAR(AzimuthInDegrees(up, 0), 0.0, kFloatAngle_deg);
  EXPECT_NEAR(ElevationInDegrees(up, 0), bent_deg, kFloatAngle_deg);
}

// The data sheet of the Mid-40 says 38.4 deg; Brazeal et al. find wedges of 18 deg.
TEST(RisleyPattern, AlignedPrismsReachTheFieldOfViewOfTheDataSheet) {
  const ScanPattern aligned = PatternOf(OneBeam({Standing(18.0, 30.0), Standing(18.0, 30.0)}));
  EXPECT_NEAR(2.0 * FromAxis_deg(aligned, 0), 38.4, 0.05);
  const ScanPattern opposed = PatternOf(OneBeam({Standing(18.0, 30.0), Standing(18.0, 210.0)}));
  EXPECT_NEAR(FromAxis_deg(opposed, 0), 0.0, kFloatAngle_deg);
}

// A thin prism bends by (n - 1) wedge, with an error of n (n^2 - 1) / 6 wedge^3: 2e-5 deg here.
TEST(RisleyPattern, ThinPrismsAddTheirDeflectionsAndThickOnesBendMore) {
  const double bent_deg = 0.51 * 0.5;
  for (double first_deg = 0.0; first_deg < 360.0; first_deg += 40.0) {
    const double second_deg = 250.0 - first_deg;
    const std::complex<double> sum_deg =
        std::polar(bent_deg, RadFromDeg(first_deg)) + std::polar(bent_deg, RadFromDeg(second_deg));
    const ScanPattern thin =
        PatternOf(OneBeam({Standing(0.5, first_deg), Standing(0.5, second_deg)}));
    EXPECT_NEAR(AzimuthInDegrees(thin, 0), sum_deg.real(), 1e-4);
    EXPECT_NEAR(ElevationInDegrees(thin, 0), sum_deg.imag(), 1e-4);
  }
  const ScanPattern thick = PatternOf(OneBeam({Standing(18.0, 0.0), Standing(18.0, 0.0)}));
  EXPECT_NEAR(FromAxis_deg(thick, 0), 19.216, 1e-3);
  EXPECT_GT(FromAxis_deg(thick, 0), 2.0 * 0.51 * 18.0 + 0.8);
}

TEST(RisleyPattern, SendsAllChannelsThroughTheSamePrisms) {
  RisleySpec spec = OneBeam({Standing(0.5, 0.0), Standing(0.5, 0.0)});
  spec.channels = {{.elevation_deg = 1.0, .azimuth_deg = 0.0, .time_us = 0.0},
                   {.elevation_deg = -1.0, .azimuth_deg = 2.0, .time_us = 4.0}};
  const ScanPattern pattern = PatternOf(spec);
  EXPECT_EQ(pattern.rows, 2U);
  EXPECT_EQ(pattern.columns, 1000U);
  EXPECT_EQ(pattern.row[0], 1U);
  EXPECT_EQ(pattern.row[1], 0U);
  EXPECT_EQ(pattern.time_ns[1], 4000U);
  // Beams 2 deg from the axis meet the faces under other angles: (2 deg)^2 of the deflection.
  EXPECT_NEAR(AzimuthInDegrees(pattern, 0), 0.51, 0.001);
  EXPECT_NEAR(ElevationInDegrees(pattern, 0), 1.0, 0.001);
  EXPECT_NEAR(AzimuthInDegrees(pattern, 1), 2.51, 0.002);
  EXPECT_NEAR(ElevationInDegrees(pattern, 1), -1.0, 0.001);
}

TEST(RisleyPattern, ContinuesItsFigureFromFrameToFrame) {
  const ScanPattern pattern = PatternOf(OneBeam(Turning(18.0)));
  const ScanPattern whole = PatternOf(OneBeam(Turning(18.0), 100'000), 1.0);
  for (const std::uint32_t frame : {0U, 1U, 7U, 99U}) {
    const ScanPattern of_frame = PatternOfFrame(pattern, frame);
    for (std::size_t i = 0; i < 1000; ++i) {
      const Vector3 same = Direction(whole, 1000 * std::size_t{frame} + i);
      ASSERT_LT((Direction(of_frame, i) - same).norm(), 1e-6) << frame << ", " << i;
    }
  }
  // A minute later, the prisms have made whole numbers of turns.
  const ScanPattern later = PatternOfFrame(pattern, 6000);
  EXPECT_LT((Direction(later, 17) - Direction(pattern, 17)).norm(), 1e-6);
  const ScanPattern next = PatternOfFrame(pattern, 1);
  EXPECT_GT((Direction(next, 17) - Direction(pattern, 17)).norm(), 0.01);
}

TEST(RisleyPattern, GivesAFrameByItsIndexAlone) {
  const ScanPattern pattern = PatternOf(OneBeam(Turning(18.0)));
  ASSERT_FALSE(pattern.repeats());
  const ScanPattern seventh = PatternOfFrame(pattern, 7);
  const ScanPattern after_third = PatternOfFrame(PatternOfFrame(pattern, 3), 7);
  EXPECT_EQ(after_third.direction_x, seventh.direction_x);
  EXPECT_EQ(after_third.direction_y, seventh.direction_y);
  EXPECT_EQ(after_third.direction_z, seventh.direction_z);
  EXPECT_EQ(after_third.packet_order, seventh.packet_order);
  EXPECT_EQ(PatternOfFrame(seventh, 0).direction_y, pattern.direction_y);
  EXPECT_NE(seventh.direction_y, pattern.direction_y);
  EXPECT_EQ(seventh.time_ns, pattern.time_ns);
  EXPECT_EQ(seventh.row, pattern.row);
  EXPECT_EQ(seventh.column, pattern.column);
  std::vector<std::uint32_t> order(seventh.packet_order.begin(),
                                   seventh.packet_order.begin() + 1000);
  std::ranges::sort(order);
  for (std::uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(order[i], i);
}

TEST(RisleyPattern, DoesNotHeedThePhaseOfTheSensor) {
  const ScanSpec at_once{.rate_hz = 100.0, .pattern = OneBeam(Turning(18.0))};
  ScanSpec later = at_once;
  later.phase_s = 0.004;
  EXPECT_EQ(PatternOfFrame(BuildScanPattern(later), 5).direction_z,
            PatternOfFrame(BuildScanPattern(at_once), 5).direction_z);
}

TEST(ScanPattern, OfFramesThatAreTheSameIsThatOfEveryFrame) {
  const ScanPattern raster =
      BuildScanPattern({.rate_hz = 10.0, .pattern = RasterSpec{10.0, 10.0, 1.0}});
  ASSERT_TRUE(raster.repeats());
  EXPECT_EQ(PatternOfFrame(raster, 12).direction_y, raster.direction_y);
  EXPECT_EQ(PatternOfFrame(raster, 12).packet_order, raster.packet_order);
}

// Equal thin prisms at the angle psi to each other bend by 2 d |cos(psi / 2)|. Of a uniformly
// distributed psi, the share (2 / pi) asin(R / 2 d) is nearer to the axis than R.
TEST(RisleyPattern, FollowsTheArcsineLawFromTheAxisOut) {
  const ScanPattern pattern = PatternOf(OneBeam(Turning(0.5), 100'000), 1.0);
  const double most_deg = 2.0 * 0.51 * 0.5;
  std::vector<double> angles_deg;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    angles_deg.push_back(FromAxis_deg(pattern, i));
  }
  std::ranges::sort(angles_deg);
  // In 1 s the prisms make 199.3 turns against each other, and of the last a part.
  constexpr double kPartOfATurn = 1.0 / 199.0;
  for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const auto below = std::ranges::lower_bound(angles_deg, share * most_deg);
    const double found = static_cast<double>(below - angles_deg.begin()) / 100'000.0;
    EXPECT_NEAR(found, 2.0 / std::numbers::pi * std::asin(share), kPartOfATurn);
  }
}

/// The share of a circle that is within `reach` of one of these angles, all in turns.
double CoveredShare(std::vector<double> angles, double reach) {
  for (double& angle : angles) angle -= std::floor(angle);
  std::ranges::sort(angles);
  double share = 0.0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : angles[0] + 1.0;
    share += std::min(next - angles[i], 2.0 * reach);
  }
  return share;
}

/// Where frames from 0 on cross the circle of this angle about the axis, in turns.
std::vector<double> Crossings(const ScanPattern& pattern, double angle_deg, std::uint32_t frames) {
  std::vector<double> crossings;
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    const ScanPattern of_frame = PatternOfFrame(pattern, frame);
    for (std::size_t i = 1; i < of_frame.num_firings(); ++i) {
      const double before = FromAxis_deg(of_frame, i - 1) - angle_deg;
      const double behind = FromAxis_deg(of_frame, i) - angle_deg;
      if ((before < 0.0) == (behind < 0.0)) continue;
      const Vector3 at =
          Direction(of_frame, i - 1) +
          before / (before - behind) * (Direction(of_frame, i) - Direction(of_frame, i - 1));
      crossings.push_back(std::atan2(at.z(), at.y()) / kFullTurn_rad);
    }
  }
  return crossings;
}

// Thin prisms add exp(i a) + exp(i b) = 2 cos((a - b) / 2) exp(i (a + b) / 2). The beam crosses the
// circle of half the greatest angle when a - b is 120 or 240 deg, in the second case on the other
// side.
std::vector<double> CrossingsByFormula(double time_s) {
  const double a_hz = -4664.0 / 60.0;
  const double b_hz = 7294.0 / 60.0;
  std::vector<double> crossings;
  for (int turn = 0; turn < (b_hz - a_hz) * time_s; ++turn) {
    for (const double share : {1.0 / 3.0, 2.0 / 3.0}) {
      const double t_s = (turn + share) / (b_hz - a_hz);
      // Half the difference also passes through half a turn with every turn.
      const double side = turn % 2 == (share < 0.5 ? 0 : 1) ? 0.0 : 0.5;
      if (t_s < time_s) crossings.push_back(0.5 * (a_hz + b_hz) * t_s + side);
    }
  }
  return crossings;
}

TEST(RisleyPattern, CoversMoreOfItsViewTheLongerItLooks) {
  const ScanPattern pattern = PatternOf(OneBeam(Turning(0.5)));
  constexpr double kReach = 0.5 / 360.0;
  // Of a crossing between two frames, and of the angle between two firings.
  constexpr double kTolerance = 0.015;
  double last = 0.0;
  for (const std::uint32_t num_frames : {5U, 10U, 20U, 50U, 100U}) {
    const double covered = CoveredShare(Crossings(pattern, 0.51 * 0.5, num_frames), kReach);
    EXPECT_NEAR(covered, CoveredShare(CrossingsByFormula(0.01 * num_frames), kReach), kTolerance)
        << num_frames;
    EXPECT_GT(covered, last);
    last = covered;
  }
}

TEST(RisleyPattern, RefusesPrismsThatCannotBe) {
  RisleySpec spec = OneBeam({{.wedge_deg = -1.0, .refractive_index = 0.9, .turns_hz = 2e4},
                             {.wedge_deg = std::numeric_limits<double>::quiet_NaN(),
                              .refractive_index = 1.5,
                              .start_deg = 400.0}});
  EXPECT_EQ(FaultsOf(spec),
            "/pattern/prisms/0/wedge_deg: must be >= 0 and <= 60 (got -1)\n"
            "/pattern/prisms/0/refractive_index: must be >= 1 and <= 4 (got 0.9)\n"
            "/pattern/prisms/0/turns_hz: must be >= -10000 and <= 10000 (got 20000)\n"
            "/pattern/prisms/1/wedge_deg: must be >= 0 and <= 60 (got nan)\n"
            "/pattern/prisms/1/start_deg: must be >= -360 and <= 360 (got 400)");
  EXPECT_EQ(FaultsOf(OneBeam({})), "/pattern/prisms: must have 1 to 4 prisms (got 0)");
  const std::vector<PrismSpec> many(5, Standing(1.0, 0.0));
  EXPECT_EQ(FaultsOf(OneBeam(many)), "/pattern/prisms: must have 1 to 4 prisms (got 5)");
}

// Glass of 1.51 reflects totally from 41.5 deg on.
TEST(RisleyPattern, RefusesPrismsThatMayReflectABeamTotally) {
  EXPECT_EQ(FaultsOf(OneBeam({Standing(41.0, 0.0)})), "no error");
  const std::string rule = "must be smaller, since beams may be reflected totally (got ";
  EXPECT_EQ(FaultsOf(OneBeam({Standing(42.0, 0.0)})),
            "/pattern/prisms/0/wedge_deg: " + rule + "42)");
  EXPECT_EQ(FaultsOf(OneBeam({Standing(18.0, 0.0), Standing(42.0, 0.0)})),
            "/pattern/prisms/1/wedge_deg: " + rule + "42)");
  RisleySpec backwards = OneBeam({Standing(1.0, 0.0)});
  backwards.channels[0].azimuth_deg = 91.0;
  EXPECT_EQ(FaultsOf(backwards), "/pattern/prisms/0/wedge_deg: " + rule + "1)");
}

TEST(RisleyPattern, RefusesCyclesLongerThanThePeriod) {
  EXPECT_EQ(FaultsOf(OneBeam(Turning(18.0), 1001)),
            "/pattern/columns: columns x cycle_us must be <= 1 / rate_hz (got 10010)");
}

}  // namespace
}  // namespace railcast
