#include "analysis/compare/compare_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace railcast {
namespace {

using testing::StartsWith;

// Intensities of 1/255, 2/255, ... 255/255, times `scale`, the darker the more of them.
Histogram Counted(double scale) {
  ComparedCloud cloud;
  for (int step = 1; step <= 255; ++step) {
    for (int i = 0; i < 1 + 300 / step; ++i) {
      cloud.intensity.push_back(static_cast<float>(scale * step / 255.0));
    }
  }
  return HistogramsOf(cloud).intensity;
}

// A bin is an eighth octave wide.
const double kBin = std::exp2(1.0 / 8.0);

TEST(IntensityFactor, IsTheFactorBetweenByteAndShare) {
  const auto scale = IntensityFactorOf(Counted(1.0), Counted(255.0));
  ASSERT_TRUE(scale);
  EXPECT_GT(scale->b_over_a, 255.0 / kBin);
  EXPECT_LT(scale->b_over_a, 255.0 * kBin);
  EXPECT_LT(scale->largest_left, kBin);
}

TEST(IntensityFactor, IsInverseTheOtherWayRound) {
  const auto there = IntensityFactorOf(Counted(1.0), Counted(255.0));
  const auto back = IntensityFactorOf(Counted(255.0), Counted(1.0));
  ASSERT_TRUE(there && back);
  EXPECT_NEAR(there->b_over_a * back->b_over_a, 1.0, 1e-12);
  EXPECT_NEAR(there->largest_left, back->largest_left, 1e-12);
}

TEST(IntensityFactor, IsNoneOfWhatIsAlike) {
  EXPECT_FALSE(IntensityFactorOf(Counted(1.0), Counted(1.0)));
  EXPECT_FALSE(IntensityFactorOf(Counted(1.0), Counted(1.05)));
  EXPECT_FALSE(IntensityFactorOf(Histogram(), Counted(1.0)));
}

TEST(IntensityFactor, IsNoneOfWhatIsSpreadOtherwise) {
  ComparedCloud one, wide;
  for (int i = 0; i < 100; ++i) {
    one.intensity.push_back(0.5F);
    wide.intensity.push_back(std::exp2(-0.09F * static_cast<float>(i)));
  }
  EXPECT_FALSE(IntensityFactorOf(HistogramsOf(one).intensity, HistogramsOf(wide).intensity));
}

TEST(IntensityFactor, IsSaidInOneSentence) {
  EXPECT_THAT(InWords({254.7, 1.034}),
              StartsWith("The intensities of B are those of A times 255: scaled by that, their "
                         "deciles differ by 3.4 % at most, "));
}

}  // namespace
}  // namespace railcast
