// The alignment of a real line of 29.6 km: precision over its whole length.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "railcast/alignment.h"
#include "tests/core/rail/line/alignment_files.h"

namespace railcast {
namespace {

const Alignment& Line() {
  static const Alignment alignment(ReadStGallenWil());
  return alignment;
}

double CurvatureOf(const std::optional<double>& radius_m) {
  return radius_m ? 1.0 / *radius_m : 0.0;
}

// The highest rate of curvature change that follows from the data and the smoothing of jumps.
double SteepestCurvatureChange() {
  const auto course = std::get<AlignmentSectionsSpec>(ReadStGallenWil().course);
  double steepest_per_m2 = 0.0;
  for (std::size_t i = 0; i < course.sections.size(); ++i) {
    const CurvatureSection& section = course.sections[i];
    const double end_s_m =
        i + 1 < course.sections.size() ? course.sections[i + 1].s_m : course.length_m;
    const double rise_per_m =
        CurvatureOf(section.radius_end_m) - CurvatureOf(section.radius_start_m);
    steepest_per_m2 = std::max(steepest_per_m2, std::abs(rise_per_m) / (end_s_m - section.s_m));
  }
  for (const SmoothedJump& jump : Line().smoothed_jumps()) {
    if (jump.quantity != "curvature") continue;
    steepest_per_m2 = std::max(steepest_per_m2, std::abs(jump.after - jump.before) / jump.length_m);
  }
  return steepest_per_m2;
}

TEST(StGallenWil, HasTheFiguresOfTtobench) {
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/track_alignment_ttobench/CH_StGallen_Wil.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  const AlignmentSpec theirs = ReadTtobench(file);
  const AlignmentSpec ours = ReadStGallenWil();
  EXPECT_EQ(ours.course, theirs.course);
  EXPECT_EQ(ours.gradients_permil, theirs.gradients_permil);
  EXPECT_EQ(ours.speed_limits_kmph, theirs.speed_limits_kmph);
  EXPECT_EQ(ours.origin_m, theirs.origin_m);
}

TEST(StGallenWil, SmoothsSevenJumpsOfCurvatureAnd152GradientSteps) {
  int num_curvature = 0;
  int num_gradient = 0;
  for (const SmoothedJump& jump : Line().smoothed_jumps()) {
    ++(jump.quantity == "curvature" ? num_curvature : num_gradient);
    EXPECT_GT(jump.length_m, 0.0);
    EXPECT_LE(jump.length_m, jump.quantity == "curvature" ? 20.0 : 40.0);
    EXPECT_NE(jump.before, jump.after);
  }
  EXPECT_EQ(num_curvature, 7);
  EXPECT_EQ(num_gradient, 152);
}

TEST(StGallenWil, HasItsTightestRadius) {
  EXPECT_NEAR(Line().tightest_radius_m(), 340.1, 1e-9);
}

TEST(StGallenWil, HasChainageExactToAMillimetre) {
  const double step_m = 0.1;
  const auto num_steps = static_cast<int>(Line().length_m() / step_m);
  double sum_m = 0.0;
  Vector3 before_m = Line().At(0.0).position_m;
  for (int i = 1; i <= num_steps; ++i) {
    const Vector3 position_m = Line().At(i * step_m).position_m;
    sum_m += (position_m - before_m).head<2>().norm();
    // Chords are shorter than arcs by a relative (step / radius)^2 / 24 < 4e-9: 0.1 mm in 30 km.
    ASSERT_NEAR(sum_m, i * step_m, 1e-3);
    before_m = position_m;
  }
}

TEST(StGallenWil, HasContinuousCurvature) {
  const double step_m = 0.01;
  const double largest_step_per_m = SteepestCurvatureChange() * step_m * (1.0 + 1e-6);
  double before_per_m = Line().At(0.0).curvature_per_m;
  for (int i = 1; i * step_m <= Line().length_m(); ++i) {
    const double curvature_per_m = Line().At(i * step_m).curvature_per_m;
    ASSERT_LE(std::abs(curvature_per_m - before_per_m), largest_step_per_m) << i * step_m;
    before_per_m = curvature_per_m;
  }
}

TEST(StGallenWil, TurnsByTheIntegralOfItsCurvature) {
  const double step_m = 0.1;
  // The trapezoidal rule is exact except at the 252 changes of slope, where it errs by at most
  // slope step^2 / 4.
  const double tolerance_rad = 252.0 * SteepestCurvatureChange() * step_m * step_m / 4.0;
  double heading_rad = Line().At(0.0).heading_rad;
  for (int i = 0; (i + 1) * step_m <= Line().length_m(); ++i) {
    heading_rad +=
        0.5 * step_m *
        (Line().At(i * step_m).curvature_per_m + Line().At((i + 1) * step_m).curvature_per_m);
    ASSERT_NEAR(Line().At((i + 1) * step_m).heading_rad, heading_rad, tolerance_rad);
  }
}

TEST(StGallenWil, IntegratesItsHeadingToAMicrometre) {
  const double step_m = 0.25;
  long double x_m = 0.0L;
  long double y_m = 0.0L;
  for (int i = 0; (i + 1) * step_m <= Line().length_m(); ++i) {
    // Simpson's rule in long double; at a change of slope, its error is less than 1e-9 m.
    for (const auto& [part, weight] : {std::pair{0.0, 1.0L}, {0.5, 4.0L}, {1.0, 1.0L}}) {
      const auto heading_rad = static_cast<long double>(Line().At((i + part) * step_m).heading_rad);
      x_m += weight * std::cos(heading_rad) * static_cast<long double>(step_m) / 6.0L;
      y_m += weight * std::sin(heading_rad) * static_cast<long double>(step_m) / 6.0L;
    }
    const Vector3 position_m = Line().At((i + 1) * step_m).position_m;
    ASSERT_NEAR(position_m.x(), static_cast<double>(x_m), 1e-6);
    ASSERT_NEAR(position_m.y(), static_cast<double>(y_m), 1e-6);
  }
}

TEST(StGallenWil, KeepsTheHeightOfTheGivenGradients) {
  const AlignmentSpec spec = ReadStGallenWil();
  double height_m = spec.origin_m[2];
  for (std::size_t i = 0; i < spec.gradients_permil.size(); ++i) {
    const double end_s_m =
        i + 1 < spec.gradients_permil.size() ? spec.gradients_permil[i + 1].s_m : Line().length_m();
    height_m += 1e-3 * spec.gradients_permil[i].value * (end_s_m - spec.gradients_permil[i].s_m);
  }
  EXPECT_NEAR(Line().At(Line().length_m()).position_m.z(), height_m, 1e-9);
}

TEST(StGallenWil, LeadsFromStGallenToWil) {
  // Wil lies 24.7 km west and 4.4 km north of St. Gallen (map coordinates, to 0.1 km).
  const Vector3 end_m = Line().At(Line().length_m()).position_m;
  EXPECT_NEAR(end_m.x(), -24.7e3, 200.0);
  EXPECT_NEAR(end_m.y(), 4.4e3, 200.0);
}

}  // namespace
}  // namespace railcast
