#include "core/detect/base/normal_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

TEST(NormalTable, DensityAndShareAreThoseOfTheCLibrary) {
  const double scale = 1.0 / std::sqrt(2.0 * std::numbers::pi);
  for (int i = -70'000; i <= 70'000; ++i) {
    const double x = 1e-4 * i;
    EXPECT_NEAR(NormalDensity(x), scale * std::exp(-0.5 * x * x), x * x < 36.0 ? 1e-9 : 7e-9) << x;
    const double expected = 0.5 * std::erf(x / std::numbers::sqrt2) + 0.5;
    EXPECT_NEAR(NormalShare(-1e300, x), expected, 3e-9) << x;
  }
  EXPECT_EQ(NormalShare(-7.0, 7.0), 1.0);
}

}  // namespace
}  // namespace railcast
