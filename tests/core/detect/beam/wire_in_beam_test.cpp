#include "core/detect/beam/wire_in_beam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/core/detect/beam/wire_samples.h"

namespace railcast {
namespace {

constexpr int kNumSamples = 1'000'000;
constexpr double kMilli = 1e-3;
// A beam of 3.0 x 1.5 mrad, the full angle between the 1/e^2 points.
constexpr double kSigmaWide_rad = 0.75 * kMilli;
constexpr double kSigmaNarrow_rad = 0.375 * kMilli;
constexpr double kContact_m = 6e-3;

void ExpectAsSampled(const std::string& name, const WideBeam& beam, const WireSegment& wire) {
  const WireInBeam found = FindWireInBeam(beam, wire);
  const WireSamples sampled = SampleWire(beam, wire, kNumSamples);
  SCOPED_TRACE(name + ": share " + std::to_string(sampled.share) + ", spread " +
               std::to_string(sampled.spread_m));
  ASSERT_GT(sampled.num_hits, 100.0);
  // Five standard errors plus a relative error of 1e-3 of the closed form.
  const double share_error = std::sqrt(sampled.share * (1.0 - sampled.share) / kNumSamples);
  EXPECT_NEAR(found.share, sampled.share, 5.0 * share_error + 1e-3 * sampled.share);
  const double mean_error_m = sampled.spread_m / std::sqrt(sampled.num_hits);
  EXPECT_NEAR(found.range_m, sampled.range_m, 6.0 * mean_error_m + 2e-3);
  // The relative standard error of a standard deviation is 1 / sqrt(2 n) for n normal samples.
  const double spread_error = 5.0 / std::sqrt(2.0 * sampled.num_hits) + 0.03;
  EXPECT_NEAR(found.spread_m, sampled.spread_m, spread_error * sampled.spread_m + 2e-3);
}

TEST(WireInBeam, ACrossingWireIsMetAsOftenAsByRandomRays) {
  for (const double range_m : {10.0, 50.0, 100.0, 200.0}) {
    for (const double offset : {0.0, 0.6, 1.5}) {
      const double z_m = offset * kSigmaNarrow_rad * range_m;
      ExpectAsSampled("across at " + std::to_string(range_m),
                      BeamTowards({1, 0, 0}, kSigmaWide_rad, kSigmaNarrow_rad),
                      MakeWire({range_m, -9.0, z_m}, {range_m, 9.0, z_m}, kContact_m));
      const double y_m = offset * kSigmaWide_rad * range_m;
      ExpectAsSampled("upright at " + std::to_string(range_m),
                      BeamTowards({1, 0, 0}, kSigmaWide_rad, kSigmaNarrow_rad),
                      MakeWire({range_m, y_m, -9.0}, {range_m, y_m, 9.0}, kContact_m));
    }
  }
}

TEST(WireInBeam, AnObliqueWireIsMetAsOftenAsByRandomRays) {
  const WideBeam beam = BeamTowards({10, 2, 1}, kSigmaWide_rad, kSigmaNarrow_rad);
  const auto wire = [&](double range_m, const Vector3& half_m) {
    const Vector3 middle_m = range_m * beam.direction + Vector3(0.0, 0.01, 0.01);
    return MakeWire(middle_m - half_m, middle_m + half_m, kContact_m);
  };
  ExpectAsSampled("tilted", beam, wire(40.0, {0, 3, 3}));
  ExpectAsSampled("slanting", beam, wire(60.0, {6, 3, 2}));
  ExpectAsSampled("slanting the other way", beam, wire(60.0, {6, -3, 2}));
  ExpectAsSampled("slanting much", beam, wire(80.0, {20, 3.5, 1}));
}

TEST(WireInBeam, AnOverheadWireThatRunsAwaySmearsItsEchoAsRandomRaysSay) {
  for (const double height_m : {4.0, 3.0, 2.0}) {
    const auto wire = MakeWire({2, 0.05, height_m}, {400, -0.2, height_m}, kContact_m);
    for (const double range_m : {30.0, 60.0, 100.0}) {
      ExpectAsSampled("overhead at " + std::to_string(range_m),
                      BeamTowards({range_m, 0.02, height_m}, kSigmaWide_rad, kSigmaNarrow_rad),
                      wire);
    }
  }
  // dr / d elevation = r^2 / h = 3.3 km / rad at 100 m, 3 m above the sensor.
  const WireInBeam found =
      FindWireInBeam(BeamTowards({100, 0, 3}, kSigmaWide_rad, kSigmaNarrow_rad),
                     MakeWire({2, 0, 3}, {400, 0, 3}, kContact_m));
  EXPECT_NEAR(found.spread_m, 1e4 / 3.0 * kSigmaNarrow_rad, 0.02);
  EXPECT_NEAR(found.sin_axis, 0.03, 1e-4);
}

// The range changes by a third within one sigma of the beam; linearising once over the whole beam
// would give 15 % less spread.
TEST(WireInBeam, AWireThatRunsAwayBarelyOverheadIsCutIntoParts) {
  for (const double range_m : {40.0, 60.0}) {
    const double height_m = range_m * kSigmaWide_rad / 0.35;
    ExpectAsSampled("barely overhead at " + std::to_string(range_m),
                    BeamTowards({range_m, 0, height_m}, kSigmaWide_rad, kSigmaWide_rad),
                    MakeWire({2, 0, height_m}, {400, 0, height_m}, kContact_m));
  }
}

TEST(WireInBeam, AWireThatEndsInTheBeamIsMetAsOftenAsByRandomRays) {
  const WideBeam beam = BeamTowards({1, 0, 0}, kSigmaWide_rad, kSigmaNarrow_rad);
  for (const double end : {-1.0, 0.0, 0.7}) {
    const double z_m = 50.0 * kSigmaNarrow_rad * end;
    ExpectAsSampled("dropper", beam, MakeWire({50, 0.01, z_m}, {50, 0.01, 3}, 2.25e-3));
    ExpectAsSampled("tilted", beam, MakeWire({50, 0.01, z_m}, {50, 0.4, 0.5}, kContact_m));
  }
  ExpectAsSampled("short", beam, MakeWire({80, 0, -0.01}, {80.02, 0.02, 0.02}, kContact_m));
}

TEST(WireInBeam, AWireWiderThanTheBeamCatchesAllOfIt) {
  const WideBeam beam = BeamTowards({1, 0, 0}, kSigmaNarrow_rad, kSigmaNarrow_rad);
  EXPECT_NEAR(FindWireInBeam(beam, MakeWire({2, -1, 0}, {2, 1, 0}, 0.01)).share, 1.0, 1e-6);
  const WireInBeam half = FindWireInBeam(beam, MakeWire({2, -1, 0.01}, {2, 1, 0.01}, 0.01));
  // The wire's edge is on the beam's axis except for radius / range squared. The wire is 13 sigmas
  // wide, and its edge is off by 2.5e-5 of that.
  EXPECT_NEAR(half.share, 0.5, 1e-3);
  EXPECT_NEAR(half.range_m, 1.995, 0.005);
}

TEST(WireInBeam, AThinWireThroughTheMiddleCatchesItsWidthOverTheBeamsDensity) {
  const double range_m = 100.0;
  const double share = FindWireInBeam(BeamTowards({1, 0, 0}, kSigmaWide_rad, kSigmaWide_rad),
                                      MakeWire({range_m, -5, 0}, {range_m, 5, 0}, 1e-3))
                           .share;
  const double thin = 2.0 * 1e-3 / (std::sqrt(2.0 * std::numbers::pi) * kSigmaWide_rad * range_m);
  // Phi(a) - Phi(-a) = 2 a phi(0) (1 - a^2 / 6 ...), a = 0.0133.
  EXPECT_NEAR(share / thin, 1.0, 1e-4);
}

// The range at which the echo of a wire through the beam's middle equals the threshold.
double WireRangeMax_m(double diameter_m, double divergence_rad, double range_at_10_percent_m) {
  const double sigma_rad = divergence_rad / 4.0;
  const auto excess = [&](double range_m) {
    const auto wire = MakeWire({range_m, -50, 0}, {range_m, 50, 0}, 0.5 * diameter_m);
    const double share = FindWireInBeam(BeamTowards({1, 0, 0}, sigma_rad, sigma_rad), wire).share;
    const double reflectance = 0.4 * std::numbers::pi / 4.0;
    return share * reflectance / (range_m * range_m) -
           0.1 / (range_at_10_percent_m * range_at_10_percent_m);
  };
  double near_m = 1.0;
  double far_m = 2000.0;
  while (far_m - near_m > 1e-3) {
    const double middle_m = 0.5 * (near_m + far_m);
    (excess(middle_m) > 0.0 ? near_m : far_m) = middle_m;
  }
  return near_m;
}

// docs/physics.md 1.6: share * rho pi / 4 / R^2 = P_min.
TEST(WireInBeam, TheEchoOfAWireFallsWithRangeCubed) {
  for (const double divergence_rad : {1.5e-3, 3.0e-3}) {
    const double sigma_rad = divergence_rad / 4.0;
    const double closed_m = std::cbrt(0.4 * std::numbers::pi / 4.0 * 0.012 * 200.0 * 200.0 /
                                      (0.1 * std::sqrt(2.0 * std::numbers::pi) * sigma_rad));
    // a < 0.14 there. The thin-wire formula's relative error of the share, a^2 / 6, corresponds to
    // a ninth of 1 % of the range.
    EXPECT_NEAR(WireRangeMax_m(0.012, divergence_rad, 200.0) / closed_m, 1.0, 2e-3);
  }
  // R^3 is proportional to the diameter and inversely proportional to divergence and threshold. The
  // last case has 8 times the threshold.
  const double range_m = WireRangeMax_m(0.002, 3e-3, 200.0);
  EXPECT_NEAR(WireRangeMax_m(0.001, 3e-3, 200.0) / range_m, std::cbrt(0.5), 1e-3);
  EXPECT_NEAR(WireRangeMax_m(0.002, 1.5e-3, 200.0) / range_m, std::cbrt(2.0), 1e-3);
  EXPECT_NEAR(WireRangeMax_m(0.002, 3e-3, 200.0 / std::sqrt(8.0)) / range_m, 0.5, 1e-3);
}

TEST(WireInBeam, AWireCutIntoChordsIsTheSameWire) {
  const auto sum_of_chords = [](const WideBeam& beam, const Vector3& begin_m, const Vector3& end_m,
                                const std::vector<double>& cuts) {
    double share = 0.0;
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      const auto at = [&](double cut) { return Vector3(begin_m + cut * (end_m - begin_m)); };
      share += FindWireInBeam(beam, MakeWire(at(cuts[i - 1]), at(cuts[i]), kContact_m)).share;
    }
    return share;
  };
  struct Case {
    Vector3 target_m, begin_m, end_m;
  };
  // Coordinates that float32 represents exactly, so that the parts lie on the wire.
  for (const Case& c :
       {Case{{50, 0, 0}, {50, -2, 0}, {50, 2, 0}}, Case{{64, 0, 0.01}, {56, -2, -1}, {72, 2, 1}},
        Case{{100, 0, 3}, {36, 0, 3}, {164, 0, 3}}}) {
    const WideBeam beam = BeamTowards(c.target_m, kSigmaWide_rad, kSigmaNarrow_rad);
    const double whole = FindWireInBeam(beam, MakeWire(c.begin_m, c.end_m, kContact_m)).share;
    EXPECT_GT(whole, 0.01);
    const double cut = sum_of_chords(beam, c.begin_m, c.end_m,
                                     {0.0, 0.25, 0.46875, 0.5, 0.515625, 0.53125, 0.75, 1.0});
    EXPECT_NEAR(cut, whole, 1e-6);
  }
}

TEST(WireInBeam, ABeamWithoutWidthIsARay) {
  const WideBeam ray = BeamTowards({1, 0, 0}, 0.0, 0.0);
  for (const double z_m : {0.0, 5.9e-3, -5.9e-3}) {
    const WireInBeam found = FindWireInBeam(ray, MakeWire({50, -2, z_m}, {50, 3, z_m}, kContact_m));
    EXPECT_EQ(found.share, 1.0);
    EXPECT_NEAR(found.range_m, 50.0, kContact_m);
    EXPECT_LT(found.spread_m, kContact_m);
  }
  for (const double z_m : {6.1e-3, -6.1e-3, 1.0}) {
    EXPECT_EQ(FindWireInBeam(ray, MakeWire({50, -2, z_m}, {50, 3, z_m}, kContact_m)).share, 0.0);
  }
  EXPECT_EQ(FindWireInBeam(ray, MakeWire({50, 0.1, 0}, {50, 3, 0}, kContact_m)).share, 0.0);
}

TEST(WireInBeam, NoPlaceOfAWireGivesANumberThatIsNone) {
  std::vector<double> places_m{-100.0, -1.0, -0.006, -1e-5, 0.0, 1e-5, 0.006, 0.02, 1.0, 300.0};
  int num_met = 0;
  const auto expect_sane = [&](const WideBeam& beam, const WireSegment& wire) {
    const WireInBeam found = FindWireInBeam(beam, wire);
    num_met += found.share > 1e-4 ? 1 : 0;
    ASSERT_TRUE(found.share >= 0.0 && found.share <= 1.0) << found.share;
    ASSERT_TRUE(found.range_m >= 0.0 && found.range_m < 500.0) << found.range_m;
    ASSERT_TRUE(found.spread_m >= 0.0 && found.spread_m < 500.0) << found.spread_m;
    ASSERT_TRUE(found.sin_axis >= 0.0 && found.sin_axis <= 1.0) << found.sin_axis;
  };
  for (const double sigma_rad : {0.0, kSigmaNarrow_rad, 0.25 * std::numbers::pi / 180.0}) {
    const WideBeam beam = BeamTowards({1, 0, 0}, sigma_rad, 0.5 * sigma_rad);
    for (const double x0 : places_m) {
      for (const double x1 : places_m) {
        for (const double y0 : places_m) {
          for (const double y1 : places_m) {
            for (const double z : {0.0, 1e-4, 0.006, 0.5}) {
              expect_sane(beam, MakeWire({x0, y0, z}, {x1, y1, -z}, kContact_m));
              expect_sane(beam, MakeWire({x0, y0, z}, {x1, y1, z}, kContact_m));
            }
          }
        }
      }
    }
  }
  EXPECT_GT(num_met, 1000);
}

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
