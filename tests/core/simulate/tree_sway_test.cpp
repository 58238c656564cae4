#include "core/simulate/tree_sway.h"

#include <gtest/gtest.h>

#include <cmath>

namespace railcast {
namespace {

const Vector3 kDownwind(0.6, -0.8, 0.0);
const Vector3 kAside(0.8, 0.6, 0.0);
constexpr double kTreeWind_mps = 12.0;
constexpr double kTreeSigmas = 5.0;

// Moore and Maguire 2004: 10 m and 22 cm.
TEST(TreeSway, NaturalFrequencyFallsWithHeight) {
  EXPECT_NEAR(TreeFrequency_hz(10.0), 0.0766 + 3.1219 * 22.0 / 100.0, 1e-12);
  EXPECT_NEAR(TreeFrequency_hz(14.0), 0.0766 + 3.1219 * 30.8 / 196.0, 1e-12);
}

TEST(TreeSway, MeanAndRootMeanSquareAreThoseStated) {
  constexpr int kNumTrees = 20'000;
  constexpr double kHeight_m = 10.0;
  const double mean_m = 0.015 * kHeight_m * std::pow(1.2, 4.0 / 3.0);
  double along_m = 0.0;
  double along2_m2 = 0.0;
  double across_m = 0.0;
  double across2_m2 = 0.0;
  for (std::uint32_t i = 0; i < kNumTrees; ++i) {
    const Wind wind(kTreeWind_mps * kDownwind, i);
    const Vector3 tip_m = TreeTip_m(wind, {{3.0 * i, 5.0, 1.0}, kHeight_m, i / 100, i % 100}, 33.0);
    EXPECT_EQ(tip_m.z(), 0.0);
    const double along = tip_m.dot(kDownwind) - mean_m;
    const double across = tip_m.dot(kAside);
    along_m += along;
    along2_m2 += along * along;
    across_m += across;
    across2_m2 += across * across;
  }
  // R^2 at 0.763 Hz, zeta = 0.1, 12 m/s, by EN 1991-1-4 annex B.
  const double x = 0.7634 * 63.1 / 12.0;
  const double resonance = M_PI / 0.4 * 6.8 * x / std::pow(1.0 + 10.2 * x, 5.0 / 3.0);
  const double sigma_along_m = mean_m * 4.0 / 3.0 * 0.1887 * std::sqrt(0.8 + resonance);
  const double sigma_across_m = mean_m * 0.8 * 0.1887 * std::sqrt(0.8 + resonance);
  const double mean_tolerance = kTreeSigmas / std::sqrt(kNumTrees);
  const double square_tolerance = kTreeSigmas * std::sqrt(2.0 / kNumTrees);
  EXPECT_NEAR(along_m / kNumTrees, 0.0, mean_tolerance * sigma_along_m);
  EXPECT_NEAR(across_m / kNumTrees, 0.0, mean_tolerance * sigma_across_m);
  EXPECT_NEAR(along2_m2 / kNumTrees / std::pow(sigma_along_m, 2), 1.0, square_tolerance);
  EXPECT_NEAR(across2_m2 / kNumTrees / std::pow(sigma_across_m, 2), 1.0, square_tolerance);
  // Some centimetres, as a tree of this size in leaf sways in such a wind.
  EXPECT_GT(sigma_along_m, 0.03);
  EXPECT_LT(sigma_along_m, 0.10);
}

TEST(TreeSway, NeighboursFeelTheSameGustsAndRingByThemselves) {
  const Wind wind(kTreeWind_mps * kDownwind, 1);
  double same = 0.0;
  double other = 0.0;
  constexpr int kNumTimes = 4000;
  for (int i = 0; i < kNumTimes; ++i) {
    const double time_s = 0.7 * i;
    const Vector3 a_m = TreeTip_m(wind, {{0, 0, 0}, 10.0, 1, 1}, time_s);
    const Vector3 b_m = TreeTip_m(wind, {{2, 0, 0}, 10.0, 1, 2}, time_s);
    const double mean_m = MeanTreeTip_m(kTreeWind_mps, 10.0);
    same += (a_m.dot(kDownwind) - mean_m) * (b_m.dot(kDownwind) - mean_m);
    other += a_m.dot(kAside) * b_m.dot(kAside);
  }
  const double scale_m2 = std::pow(MeanTreeTip_m(kTreeWind_mps, 10.0) * Wind::kTurbulence, 2);
  // Gusts have 0.8 of (4/3)^2; the two trees' own sway is independent.
  EXPECT_GT(same / kNumTimes / scale_m2, 0.7);
  EXPECT_NEAR(other / kNumTimes / scale_m2, 0.0, 0.3);
}

}  // namespace
}  // namespace railcast
