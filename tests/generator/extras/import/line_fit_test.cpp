#include "generator/extras/import/fit/line_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "generator/extras/import/fit/line_draft.h"
#include "generator/extras/import/fit/plan_model.h"

namespace railcast {
namespace {

using ::testing::ElementsAre;

/// Points of a plan as mappers draw them: more of them in curves, off by sigma_m across the track.
std::vector<Eigen::Vector2d> MappedPoints(const PlanModel& plan, double sigma_m, unsigned seed) {
  std::mt19937 dice(seed);
  std::normal_distribution<double> off(0.0, 1.0);
  std::uniform_real_distribution<double> step(0.6, 1.4);
  const PlanCourse course = plan.Course();
  std::vector<Eigen::Vector2d> points_m;
  for (double s_m = 0.0; s_m < plan.length_m();) {
    const PlanPoint at = course.At(s_m);
    const double offset_m = sigma_m * off(dice);
    points_m.emplace_back(at.x_m - offset_m * std::sin(at.heading_rad),
                          at.y_m + offset_m * std::cos(at.heading_rad));
    s_m += step(dice) * (at.curvature_per_m == 0.0 ? 60.0 : 30.0);
  }
  const PlanPoint end = course.At(plan.length_m());
  points_m.emplace_back(end.x_m, end.y_m);
  return points_m;
}

/// The largest distance between two plans, at points of the first one.
double LargestDistance_m(const PlanModel& plan, const PlanModel& from) {
  const PlanCourse course = plan.Course();
  const PlanCourse other = from.Course();
  double largest_m = 0.0;
  double guess_m = 0.0;
  constexpr double kStep_m = 10.0;
  for (double s_m = 0.0; s_m < plan.length_m(); s_m += kStep_m) {
    const PlanPoint at = course.At(s_m);
    const Foot foot = FootOn(other, from.length_m(), {at.x_m, at.y_m}, guess_m);
    largest_m = std::max(largest_m, std::abs(foot.offset_m));
    guess_m = foot.s_m + kStep_m;
  }
  return largest_m;
}

/// A line for 120 km/h: straights, a single curve, a reverse curve and a compound one.
PlanModel MainLine() {
  PlanModel plan;
  plan.start.heading_rad = 0.4;
  plan.plateaus = {{0.0, 900.0},          {1.0 / 800.0, 500.0}, {0.0, 700.0},
                   {-1.0 / 700.0, 400.0}, {1.0 / 900.0, 450.0}, {0.0, 800.0},
                   {1.0 / 1500.0, 400.0}, {1.0 / 650.0, 350.0}, {0.0, 600.0}};
  plan.clothoids_m = {110.0, 110.0, 120.0, 180.0, 100.0, 70.0, 90.0, 130.0};
  return plan;
}

LinePrior ForSpeed(double speed_kmph, double sigma_m) {
  return {.sigma_m = sigma_m, .speed_kmph = [=](double) { return speed_kmph; }};
}

TEST(LineFit, FindsTheElementsFromWhichPointsWereMade) {
  const PlanModel truth = MainLine();
  constexpr double kSigma_m = 0.02;
  const LineFit fit = FitLine(MappedPoints(truth, kSigma_m, 1), ForSpeed(120.0, kSigma_m));
  ASSERT_EQ(fit.plan.plateaus.size(), truth.plateaus.size());
  for (std::size_t i = 0; i < truth.plateaus.size(); ++i) {
    const double curvature_per_m = truth.plateaus[i].curvature_per_m;
    EXPECT_NEAR(fit.plan.plateaus[i].curvature_per_m, curvature_per_m,
                0.02 * std::abs(curvature_per_m))
        << i;
    EXPECT_NEAR(fit.plan.plateaus[i].length_m, truth.plateaus[i].length_m, 25.0) << i;
  }
  EXPECT_LT(LargestDistance_m(truth, fit.plan), 4.0 * kSigma_m);
}

TEST(LineFit, NeedsNoMoreElementsThanTheLineHasFromNoisyPoints) {
  const PlanModel truth = MainLine();
  constexpr double kSigma_m = 0.3;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const LineFit fit = FitLine(MappedPoints(truth, kSigma_m, seed), ForSpeed(120.0, kSigma_m));
    EXPECT_LE(fit.plan.plateaus.size(), truth.plateaus.size()) << seed;
    EXPECT_GE(fit.plan.plateaus.size(), truth.plateaus.size() - 2) << seed;
    // Some ten points hold each element: its place is known to about sigma / 3 in its middle, and
    // three times worse between elements.
    EXPECT_LT(LargestDistance_m(truth, fit.plan), 4.0 * kSigma_m) << seed;
  }
}

TEST(LineFit, LeavesAStraightLineStraight) {
  PlanModel truth;
  truth.start = {.x_m = 5.0, .y_m = -3.0, .heading_rad = 2.0};
  truth.plateaus = {{0.0, 3000.0}};
  const LineFit fit = FitLine(MappedPoints(truth, 0.3, 7), ForSpeed(100.0, 0.3));
  ASSERT_EQ(fit.plan.plateaus.size(), 1U);
  EXPECT_EQ(fit.plan.plateaus.front().curvature_per_m, 0.0);
  EXPECT_LT(LargestDistance_m(truth, fit.plan), 0.5);
  EXPECT_NEAR(fit.plan.length_m(), 3000.0, 1.0);
}

TEST(LineFit, IsNotBentByOnePointThatIsFarOff) {
  const PlanModel truth = MainLine();
  std::vector<Eigen::Vector2d> points_m = MappedPoints(truth, 0.1, 3);
  points_m[points_m.size() / 2] += Eigen::Vector2d(0.0, 4.0);
  const LineFit fit = FitLine(points_m, ForSpeed(120.0, 0.3));
  EXPECT_LT(LargestDistance_m(truth, fit.plan), 1.0);
}

TEST(LineFit, TakesTwoPointsForAStraight) {
  const std::vector<Eigen::Vector2d> points_m = {{0.0, 0.0}, {30.0, 40.0}};
  const LineFit fit = FitLine(points_m, ForSpeed(80.0, 0.3));
  ASSERT_EQ(fit.plan.plateaus.size(), 1U);
  EXPECT_NEAR(fit.plan.length_m(), 50.0, 0.1);
  EXPECT_NEAR(fit.plan.start.heading_rad, std::atan2(4.0, 3.0), 1e-2);
}

TEST(LineFit, FindsTheSharpCurveOfATram) {
  PlanModel truth;
  truth.plateaus = {{0.0, 100.0}, {1.0 / 20.0, 32.0}, {0.0, 100.0}};
  truth.clothoids_m = {6.0, 6.0};
  std::vector<Eigen::Vector2d> points_m;
  const PlanCourse course = truth.Course();
  for (double s_m = 0.0; s_m <= truth.length_m(); s_m += 2.0) {
    points_m.emplace_back(course.At(s_m).x_m, course.At(s_m).y_m);
  }
  const LineFit fit = FitLine(points_m, ForSpeed(20.0, 0.05));
  double sharpest_per_m = 0.0;
  for (const Plateau& plateau : fit.plan.plateaus) {
    sharpest_per_m = std::max(sharpest_per_m, plateau.curvature_per_m);
  }
  EXPECT_NEAR(1.0 / sharpest_per_m, 20.0, 2.0);
  EXPECT_LT(LargestDistance_m(truth, fit.plan), 0.2);
}

TEST(LineFit, KeepsTheLengthOfAStraightAcrossACountry) {
  std::vector<Eigen::Vector2d> points_m;
  constexpr double kLength_m = 222e3;
  for (double x_m = 0.0; x_m <= kLength_m; x_m += 2000.0) points_m.emplace_back(x_m, 0.0);
  const LineFit fit = FitLine(points_m, ForSpeed(120.0, 0.3));
  EXPECT_NEAR(fit.plan.length_m(), kLength_m, 1.0);
}

TEST(LineFit, ShowsThePointsBehindTheEndOfALineThatTurnsBack) {
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 0.0; x_m <= 2000.0; x_m += 50.0) points_m.emplace_back(x_m, 0.0);
  for (double x_m = 1950.0; x_m >= 600.0; x_m -= 50.0) points_m.emplace_back(x_m, 0.0);
  const LineFit fit = FitLine(points_m, ForSpeed(80.0, 0.3));
  double largest_m = 0.0;
  for (const double offset_m : fit.offsets_m) largest_m = std::max(largest_m, std::abs(offset_m));
  EXPECT_TRUE(fit.plan.length_m() > 3000.0 || largest_m > 20.0)
      << fit.plan.length_m() << ' ' << largest_m;
}

TEST(LineFit, MeasuresPointsBehindTheEndsFromThese) {
  PlanModel plan;
  plan.plateaus = {{0.0, 100.0}};
  const std::vector<Eigen::Vector2d> points_m = {{-3.0, 4.0}, {50.0, -1.0}, {112.0, -5.0}};
  const LineFit fit = MeasureFit(plan, points_m, std::vector<double>{0.0, 50.0, 100.0});
  EXPECT_THAT(fit.offsets_m, ::testing::Pointwise(::testing::DoubleNear(1e-9),
                                                  std::vector<double>{5.0, -1.0, -13.0}));
}

TEST(LineFit, GivesTheElementsOfAnAlignmentOfTheSamePlan) {
  const PlanModel plan = MainLine();
  AlignmentSpec spec;
  spec.course = AlignmentElementsSpec{plan.Elements()};
  spec.heading_deg = plan.start.heading_rad * 180.0 / M_PI;
  const Alignment alignment(spec);
  ASSERT_NEAR(alignment.length_m(), plan.length_m(), 1e-6);
  const PlanCourse course = plan.Course();
  for (double s_m = 0.0; s_m < plan.length_m(); s_m += 50.0) {
    EXPECT_NEAR(alignment.At(s_m).position_m.x(), course.At(s_m).x_m, 1e-5) << s_m;
    EXPECT_NEAR(alignment.At(s_m).position_m.y(), course.At(s_m).y_m, 1e-5) << s_m;
  }
}

TEST(LineFit, KeepsTheEndOfALongLineInItsRoundedElements) {
  PlanModel plan;
  for (int i = 0; i < 40; ++i) {
    // Of alternate sides, but unequal, so that what is rounded does not cancel out.
    plan.plateaus.push_back({0.0, 750.12344});
    plan.plateaus.push_back({(i % 2 == 0 ? 1.0 : -1.0) / (500.0004 + 0.00003 * i), 500.00004});
    plan.clothoids_m.insert(plan.clothoids_m.end(), 2, 100.00002);
  }
  plan.clothoids_m.pop_back();
  const PlanModel rounded = PlanOf(plan.start, plan.Elements());
  const PlanPoint end = plan.Course().At(plan.length_m());
  const PlanPoint rounded_end = rounded.Course().At(rounded.length_m());
  // Lengths are off by 0.05 mm each at most, on 159 elements, and turn it by 1e-7 rad on each arc,
  // half of which cancels out.
  EXPECT_LT(std::hypot(end.x_m - rounded_end.x_m, end.y_m - rounded_end.y_m), 0.05);
  for (const AlignmentElement& element : plan.Elements()) {
    if (!element.radius_m) continue;
    EXPECT_GT(std::abs(*element.radius_m), 500.00039) << "not rounded to mm";
  }
}

/// The radii of a plan's arcs, without sign.
std::vector<double> RadiiOf_m(const PlanModel& plan) {
  std::vector<double> radii_m;
  for (const Plateau& plateau : plan.plateaus) {
    if (plateau.curvature_per_m != 0.0) radii_m.push_back(1.0 / std::abs(plateau.curvature_per_m));
  }
  return radii_m;
}

TEST(LineFit, MakesNoFlatArcsOfPointsThatAreOffTogether) {
  // Within 1200 m the points leave a straight by up to 0.7 m and return to it, as a swing of the
  // pen does.
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 0.0; x_m <= 4000.0; x_m += 25.0) {
    const double inside_m = std::clamp(x_m - 1400.0, 0.0, 1200.0);
    points_m.emplace_back(x_m, 0.35 * (1.0 - std::cos(2.0 * M_PI * inside_m / 1200.0)));
  }
  const LineFit fit = FitLine(points_m, ForSpeed(160.0, 0.3));
  EXPECT_THAT(RadiiOf_m(fit.plan), ::testing::Each(::testing::Lt(20e3)));
}

/// A straight track of 2 km whose points swing to one side and back, every 5 m.
std::vector<Eigen::Vector2d> SwingingPoints(double most_m) {
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 0.0; x_m <= 2000.0; x_m += 5.0) {
    const double inside_m = std::clamp(x_m - 400.0, 0.0, 1200.0);
    points_m.emplace_back(x_m, 0.5 * most_m * (1.0 - std::cos(2.0 * M_PI * inside_m / 1200.0)));
  }
  return points_m;
}

TEST(LineFit, KeepsAFlatArcOnlyWhereAStraightWouldLeaveThePoints) {
  // However many points show a swing: within 2 sigma of 0.3 m, a straight explains them.
  for (const double most_m : {0.45, 0.6}) {
    const LineFit fit = FitLine(SwingingPoints(most_m), ForSpeed(160.0, 0.3));
    EXPECT_THAT(RadiiOf_m(fit.plan), ::testing::Each(::testing::Lt(20e3))) << most_m;
    for (const double offset_m : fit.offsets_m) EXPECT_LE(std::abs(offset_m), 0.6) << most_m;
  }
  const LineFit fit = FitLine(SwingingPoints(3.0), ForSpeed(160.0, 0.3));
  EXPECT_THAT(RadiiOf_m(fit.plan), ::testing::Contains(::testing::Gt(20e3)));
}

TEST(LineFit, KeepsAFlatArcThatManyPointsShow) {
  PlanModel truth;
  truth.plateaus = {{0.0, 2000.0}, {1.0 / 30e3, 2500.0}, {0.0, 2000.0}};
  truth.clothoids_m = {60.0, 60.0};
  const LineFit fit = FitLine(MappedPoints(truth, 0.1, 4), ForSpeed(200.0, 0.3));
  EXPECT_THAT(RadiiOf_m(fit.plan), ElementsAre(::testing::DoubleNear(30e3, 3e3)));
}

TEST(LineFit, HasClothoidsOnFastLinesThatTheirSpeedCanRunThrough) {
  // Points every 60 m and 0.3 m off do not show where a clothoid of 40 m begins.
  PlanModel truth;
  truth.plateaus = {{0.0, 1500.0}, {1.0 / 2200.0, 900.0}, {0.0, 1500.0}};
  truth.clothoids_m = {40.0, 40.0};
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const LineFit fit = FitLine(MappedPoints(truth, 0.3, seed), ForSpeed(200.0, 0.3));
    for (std::size_t i = 0; i < fit.plan.clothoids_m.size(); ++i) {
      EXPECT_GE(fit.plan.clothoids_m[i],
                0.4 * UsualClothoid_m(200.0, fit.plan.plateaus[i].curvature_per_m,
                                      fit.plan.plateaus[i + 1].curvature_per_m))
          << seed;
    }
  }
}

/// A metro's straights and curves, over and over, with a point every 15 m.
std::vector<Eigen::Vector2d> MetroPoints(int num_curves) {
  PlanModel plan;
  for (int i = 0; i < num_curves; ++i) {
    plan.plateaus.push_back({0.0, 250.0 + 37.0 * (i % 5)});
    plan.plateaus.push_back({(i % 2 == 0 ? 1.0 : -1.0) / (300.0 + 41.0 * (i % 7)), 180.0});
  }
  plan.plateaus.push_back({0.0, 300.0});
  plan.clothoids_m.assign(plan.plateaus.size() - 1, 40.0);
  const PlanCourse course = plan.Course();
  std::vector<Eigen::Vector2d> points_m;
  for (double s_m = 0.0; s_m < plan.length_m(); s_m += 15.0) {
    points_m.emplace_back(course.At(s_m).x_m, course.At(s_m).y_m);
  }
  return points_m;
}

TEST(LineDraft, TakesFourTimesTheWorkForFourTimesTheLine) {
  const auto work = [](int num_curves) {
    const LinePrior prior = ForSpeed(80.0, 0.3);
    const std::vector<Eigen::Vector2d> points_m = MetroPoints(num_curves);
    return static_cast<double>(LineDraft(points_m, prior).num_feet());
  };
  // Were all feet sought anew after each arc, it would be more than five times.
  EXPECT_NEAR(work(160) / work(40), 4.0, 0.4);
}

TEST(LineFit, TellsHowMuchOfItIsDone) {
  std::vector<double> shares;
  static_cast<void>(
      FitLine(MetroPoints(5), ForSpeed(80.0, 0.3), [&](double share) { shares.push_back(share); }));
  ASSERT_GT(shares.size(), 10U);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GT(shares.front(), 0.0);
  EXPECT_LT(shares.back(), 1.0);
}

TEST(UsualClothoid, IsTheRampOfTheCant) {
  // 120 km/h and 800 m: 212 mm balance, 127 mm are built, and the ramp rises by 1 mm in 1.2 m.
  EXPECT_NEAR(UsualClothoid_m(120.0, 0.0, 1.0 / 800.0), 152.9, 0.1);
  EXPECT_EQ(UsualClothoid_m(40.0, 0.0, 1.0 / 5000.0), 15.0);
  EXPECT_EQ(UsualClothoid_m(250.0, 0.0, 1.0 / 60e3), 50.0) << "0.2 m for each km/h";
}

}  // namespace
}  // namespace railcast
