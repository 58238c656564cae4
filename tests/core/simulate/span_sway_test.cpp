#include "core/simulate/span_sway.h"

#include <gtest/gtest.h>

#include <cmath>

namespace railcast {
namespace {

/// 65 m to the north, of the default contact line.
WireSpan NorthwardSpan() {
  return {.number = 4,
          .begin_m = {100.0, 200.0, 5.5},
          .end_m = {100.0, 265.0, 5.5},
          .tension_n = 20e3,
          .mass_kg_per_m = 1.3256,
          .width_m = 0.021};
}

// q = 1.25 / 2 x 0.021 m x (10 m/s)^2 = 1.3125 N/m; q L^2 / 8 T = 34.66 mm.
TEST(SpanSway, MeanBlowOffIsThatOfContactLineDesign) {
  const Wind eastward({10.0, 0.0, 0.0}, 1);
  EXPECT_NEAR(MeanSpanBlowOff_m(eastward, NorthwardSpan()), -1.3125 * 65.0 * 65.0 / 160e3, 1e-12);
  EXPECT_NEAR(MeanSpanBlowOff_m(Wind({-20.0, 0.0, 0.0}, 1), NorthwardSpan()), 4.0 * 0.034658, 1e-6);
  // Only what blows across it counts: at 30 degrees, a quarter.
  EXPECT_NEAR(MeanSpanBlowOff_m(Wind({5.0, std::sqrt(75.0), 0.0}, 1), NorthwardSpan()),
              -0.034658 / 4.0, 1e-6);
  EXPECT_NEAR(MeanSpanBlowOff_m(Wind({0.0, 10.0, 0.0}, 1), NorthwardSpan()), 0.0, 1e-12);
}

TEST(SpanSway, IsAParabolaThatIsZeroAtTheSupports) {
  const WireSpan span = NorthwardSpan();
  EXPECT_EQ(BlowOffShare(span, span.begin_m), 0.0);
  EXPECT_EQ(BlowOffShare(span, span.end_m), 0.0);
  EXPECT_EQ(BlowOffShare(span, {100.0, 232.5, 7.0}), 1.0);
  for (const double x_m : {5.0, 20.0, 48.0}) {
    const double share = 4.0 * x_m * (65.0 - x_m) / (65.0 * 65.0);
    EXPECT_NEAR(BlowOffShare(span, {100.0, 200.0 + x_m, 6.1}), share, 1e-12);
  }
  EXPECT_TRUE(LeftOf(span).isApprox(-Vector3::UnitX()));
}

TEST(SpanSway, RingsAsAStringThatTheAirDamps) {
  const Wind wind({10.0, 0.0, 0.0}, 1);
  const SpanGusts gusts = SpanGustsOf(wind, NorthwardSpan());
  EXPECT_NEAR(gusts.frequency_hz, std::sqrt(20e3 / 1.3256) / 130.0, 1e-12);
  const double drag = 1.25 * 0.021 * 10.0 / (2.0 * 1.3256 * 2.0 * M_PI * gusts.frequency_hz);
  EXPECT_NEAR(gusts.damping, 0.01 + drag, 1e-12);
}

TEST(SpanSway, RootMeanSquareIsThatStated) {
  constexpr int kNumSeeds = 20'000;
  const WireSpan span = NorthwardSpan();
  const Wind any({10.0, 0.0, 0.0}, 1);
  const double mean_m = MeanSpanBlowOff_m(any, span);
  double sum_m = 0.0;
  double sum2_m2 = 0.0;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const double sway_m = SpanBlowOff_m(Wind({10.0, 0.0, 0.0}, seed), span, 81.0) - mean_m;
    sum_m += sway_m;
    sum2_m2 += sway_m * sway_m;
  }
  const double background = 0.8 / (1.0 + 0.9 * std::pow(65.0 / 63.1, 0.63));
  const double resonance =
      any.Resonance(SpanGustsOf(any, span).frequency_hz, SpanGustsOf(any, span).damping, 65.0);
  const double sigma_m = std::abs(mean_m) * 2.0 * 0.1887 * std::sqrt(background + resonance);
  EXPECT_NEAR(sum_m / kNumSeeds, 0.0, 5.0 * sigma_m / std::sqrt(kNumSeeds));
  EXPECT_NEAR(sum2_m2 / kNumSeeds / (sigma_m * sigma_m), 1.0, 5.0 * std::sqrt(2.0 / kNumSeeds));
}

TEST(SpanSway, ASpanWithoutTensionHangsStill) {
  EXPECT_EQ(SpanBlowOff_m(Wind({10.0, 0.0, 0.0}, 1), WireSpan{}, 3.0), 0.0);
}

}  // namespace
}  // namespace railcast
