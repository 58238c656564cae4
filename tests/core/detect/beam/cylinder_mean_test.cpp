#include "core/detect/beam/cylinder_mean.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

TEST(CylinderMean, OfALambertianIsPiOverFourTimesTheSineToTheAxis) {
  for (const double sin_axis : {1.0, 0.7, 0.03}) {
    EXPECT_NEAR(CylinderMean(sin_axis, [](double cosine) { return 0.4 * cosine; }),
                0.4 * std::numbers::pi / 4.0 * sin_axis, 1e-12);
  }
}

TEST(CylinderMean, OfAConstantIsThatAndOfAPowerItsIntegral) {
  EXPECT_NEAR(CylinderMean(0.5, [](double) { return 1.0; }), 1.0, 1e-12);
  // (1 / 2) integral of (1 - u^2)^3 du = 16 / 35.
  EXPECT_NEAR(CylinderMean(1.0, [](double cosine) { return std::pow(cosine, 6); }), 16.0 / 35.0,
              1e-12);
}

// GGX at normal incidence: pi F0 D / (4 cos) with F0 = 1.
TEST(CylinderMean, ResolvesALobeOfATenthOfARadian) {
  const auto lobe = [](double cosine) {
    const double alpha2 = 0.01;
    const double base = cosine * cosine * (alpha2 - 1.0) + 1.0;
    return alpha2 / (base * base) / (4.0 * cosine);
  };
  double sum = 0.0;
  constexpr int kNumSteps = 1'000'000;
  for (int i = 0; i < kNumSteps; ++i) {
    const double cosine = std::cos(0.5 * std::numbers::pi * (i + 0.5) / kNumSteps);
    sum += cosine * lobe(cosine) * 0.5 * std::numbers::pi / kNumSteps;
  }
  EXPECT_NEAR(CylinderMean(1.0, lobe) / sum, 1.0, 1e-3);
}

}  // namespace
}  // namespace railcast
