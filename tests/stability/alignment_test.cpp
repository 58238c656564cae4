// Cases in which a line's geometry may break down: curves as tight as the gauge, cusps, elements of
// no length, and sums over a thousand kilometres.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/rail/chunk/sweep.h"
#include "core/rail/line/alignment_course.h"
#include "core/rail/line/rail_section.h"
#include "tests/stability/regime.h"
#include "tests/support/alignment_faults.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

AlignmentSpec SplineOf(std::vector<std::array<double, 2>> points_m) {
  AlignmentSpec spec;
  spec.course = AlignmentSplineSpec{std::move(points_m)};
  return spec;
}

TEST(AlignmentAtItsLimits, RefusesARadiusNearTheGauge) {
  const auto fault = [](const std::string& got) {
    return "/course/elements/0/radius_m: must be at least 10 m, negative to the right, absent "
           "where "
           "straight (got " +
           got + ")";
  };
  EXPECT_EQ(FaultOf(AlignmentOf({{ElementType::kArc, 5.0, kGauge_m}})), fault("1.435"));
  EXPECT_EQ(FaultOf(AlignmentOf({{ElementType::kArc, 5.0, -0.5 * kGauge_m}})), fault("-0.7175"));
  EXPECT_EQ(FaultOf(AlignmentOf({{ElementType::kArc, 5.0, 9.999}})), fault("9.999"));
  EXPECT_EQ(FaultOf(AlignmentOf({{ElementType::kArc, 5.0, 0.0}})), fault("0"));
  EXPECT_EQ(FaultOf(AlignmentOf({{ElementType::kArc, 5.0, std::nan("")}})), fault("nan"));
  EXPECT_EQ(FaultOf(AlignmentOf({{ElementType::kArc, 5.0, 10.0}})), "no error");
}

// Sixteen metres of the tightest curve allowed. Chords of 2.5 m, as on a straight, would be 75 mm
// off it; the sweep keeps within its millimetre and keeps the gauge.
TEST(AlignmentAtItsLimits, TheTightestCurveKeepsItsGaugeAndItsChords) {
  const Alignment alignment(AlignmentOf({{ElementType::kArc, 16.0, 10.0}}));
  const Vector3 centre_m(0.0, 10.0, 0.0);
  for (const double side : {-1.0, 1.0}) {
    const double offset_m = side * 0.5 * kGauge_m;
    const auto stations = SweepStations(alignment, {0.0, 16.0}, offset_m, 1e-3, 2.5);
    Vector3 before_m = alignment.WorldFromTrack(0.0, offset_m).translation();
    for (std::size_t i = 1; i < stations.size(); ++i) {
      const Vector3 place_m = alignment.WorldFromTrack(stations[i], offset_m).translation();
      EXPECT_NEAR((place_m - centre_m).norm(), 10.0 - offset_m, 1e-9);
      EXPECT_GE((0.5 * (before_m + place_m) - centre_m).norm(), 10.0 - offset_m - 1.001e-3);
      before_m = place_m;
    }
  }
  const double radius_m = 10.0 + 0.5 * kGauge_m;
  EXPECT_GT(radius_m - std::sqrt(radius_m * radius_m - 1.25 * 1.25), 0.07);
}

TEST(AlignmentAtItsLimits, RefusesCuspsOfASpline) {
  const std::string fault =
      "/course/points_m/0: the spline must not have a cusp between this point and the next, its "
      "radius be at least 10 m (got ";
  // The spline goes there and back on one line, so its turning point is a cusp of zero width.
  EXPECT_EQ(FaultOf(SplineOf({{0.0, 0.0}, {100.0, 0.0}, {50.0, 0.0}})), fault + "0)");
  // With a width of 1 mm, 1 cm or 10 cm the cusp is a hairpin with a radius of nanometres to
  // micrometres.
  for (const double width_m : {1e-3, 1e-2, 1e-1}) {
    const std::string got = FaultOf(SplineOf({{0.0, 0.0}, {100.0, 0.0}, {50.0, width_m}}));
    EXPECT_EQ(got.find(fault), 0U) << got;
  }
}

TEST(AlignmentAtItsLimits, RefusesElementsWithoutLength) {
  EXPECT_EQ(FaultOf(AlignmentOf(
                {{ElementType::kStraight, 100.0, {}}, {ElementType::kStraight, 0.0, {}}})),
            "/course/elements/1/length_m: must be > 0 (got 0)");
  EXPECT_EQ(
      FaultOf(AlignmentOf({{ElementType::kStraight, 100.0, {}}, {ElementType::kArc, -1.0, 300.0}})),
      "/course/elements/1/length_m: must be > 0 (got -1)");
  EXPECT_EQ(FaultOf(AlignmentOf(
                {{ElementType::kStraight, 100.0, {}}, {ElementType::kStraight, std::nan(""), {}}})),
            "/course/elements/1/length_m: must be > 0 (got nan)");
}

// The shortest element that a scenario may have, 1 mm, at the end of the longest line must do no
// harm.
TEST(AlignmentAtItsLimits, AnElementOfAMillimetreAfterAThousandKilometresIsHarmless) {
  const Alignment line(AlignmentOf({{ElementType::kStraight, 1e6, {}},
                                    {ElementType::kClothoid, 1e-3, {}},
                                    {ElementType::kArc, 1e-3, 500.0},
                                    {ElementType::kArc, 100.0, 500.0}}));
  EXPECT_NEAR(line.length_m(), 1e6 + 100.002, 1e-9);
  const AxisPoint end = line.At(line.length_m());
  EXPECT_NEAR(end.heading_rad, (100.0 + 1.5e-3) / 500.0, 1e-12);
  EXPECT_TRUE(end.position_m.allFinite());
}

/// Straight, clothoid, arc and clothoid, to the left and to the right in turn: 1,000 km in 4,000
/// elements.
std::vector<AlignmentElement> ThousandKilometres() {
  std::vector<AlignmentElement> elements;
  for (int i = 0; i < 1000; ++i) {
    const double radius_m = (i % 2 == 0 ? 1.0 : -1.0) * (400.0 + 3.7 * (i % 211));
    elements.push_back({ElementType::kStraight, 400.0, {}});
    elements.push_back({ElementType::kClothoid, 120.0, {}});
    elements.push_back({ElementType::kArc, 360.0, radius_m});
    elements.push_back({ElementType::kClothoid, 120.0, {}});
  }
  return elements;
}

double CurvatureOf(const AlignmentElement& element) {
  return element.radius_m ? 1.0 / *element.radius_m : 0.0;
}

TEST(AlignmentAtItsLimits, ChainageIsArcLengthToAMillimetreOverAThousandKilometres) {
  const Alignment line(AlignmentOf(ThousandKilometres()));
  EXPECT_EQ(line.length_m(), 1e6);
  constexpr int kNumSteps = 1'250'000;
  constexpr double kStep_m = 0.8;
  long double sum_m = 0.0L;
  float sum_in_float_m = 0.0F;
  double worst_m = 0.0;
  Vector3 before_m = line.At(0.0).position_m;
  for (int i = 1; i <= kNumSteps; ++i) {
    const Vector3 position_m = line.At(i * kStep_m).position_m;
    const double chord_m = (position_m - before_m).head<2>().norm();
    // An arc of curvature k is longer than its chord by chord^3 k^2 / 24; the next term is 5e-15 m.
    const double curvature_per_m = line.At((i - 0.5) * kStep_m).curvature_per_m;
    const double arc_m = chord_m + std::pow(chord_m, 3) * std::pow(curvature_per_m, 2) / 24.0;
    sum_m += static_cast<long double>(arc_m);
    sum_in_float_m += static_cast<float>(arc_m);
    worst_m = std::max(worst_m, std::abs(static_cast<double>(sum_m) - i * kStep_m));
    before_m = position_m;
  }
  const double float_error_m = std::abs(static_cast<double>(sum_in_float_m) - 1e6);
  RecordRegime("chainage over 1,000 km",
               {"summed in float32: " + TwoDigits(1e-3 * float_error_m) + " km off",
                TwoDigits(1e6 * worst_m) + " µm off"});
  EXPECT_LE(worst_m, 1e-3);
  EXPECT_GT(float_error_m, 1.0);
}

struct PlanEnd {
  long double x_m{};
  long double y_m{};
  long double heading_rad{};
};

/// Computes the end of the line by Simpson's rule in long double with steps of 0.5 m: the error is
/// (0.5 / 400)^4 / 2880 of the length, 1e-9 m in all.
PlanEnd ByLongDouble(const std::vector<AlignmentElement>& elements) {
  PlanEnd end;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const bool is_clothoid = elements[i].type == ElementType::kClothoid;
    const auto length_m = static_cast<long double>(elements[i].length_m);
    const auto begin_per_m =
        static_cast<long double>(CurvatureOf(elements[is_clothoid ? i - 1 : i]));
    const auto after_per_m = static_cast<long double>(is_clothoid && i + 1 < elements.size()
                                                          ? CurvatureOf(elements[i + 1])
                                                      : is_clothoid ? 0.0
                                                                    : CurvatureOf(elements[i]));
    const auto heading_rad = [&](long double s_m) {
      return end.heading_rad +
             (begin_per_m + 0.5L * (after_per_m - begin_per_m) * s_m / length_m) * s_m;
    };
    const auto num_steps = static_cast<int>(2.0 * elements[i].length_m);
    const long double step_m = length_m / static_cast<long double>(num_steps);
    for (int step = 0; step < num_steps; ++step) {
      for (const auto& [part, weight] : {std::pair{0.0L, 1.0L}, {0.5L, 4.0L}, {1.0L, 1.0L}}) {
        const long double angle_rad = heading_rad((static_cast<long double>(step) + part) * step_m);
        end.x_m += weight * step_m / 6.0L * std::cos(angle_rad);
        end.y_m += weight * step_m / 6.0L * std::sin(angle_rad);
      }
    }
    end.heading_rad = heading_rad(length_m);
  }
  return end;
}

/// Computes the end of the line as a simple simulator would: a step of 1 m along the heading, after
/// which the curvature turns the heading.
template <typename Real>
Eigen::Matrix<Real, 2, 1> ByEuler(const Alignment& line) {
  Eigen::Matrix<Real, 2, 1> place(0, 0);
  Real heading_rad = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    place += Eigen::Matrix<Real, 2, 1>(std::cos(heading_rad), std::sin(heading_rad));
    heading_rad += static_cast<Real>(line.At(i).curvature_per_m);
  }
  return place;
}

TEST(AlignmentAtItsLimits, TheEndOfAThousandKilometresIsRightToAMicrometre) {
  const Alignment line(AlignmentOf(ThousandKilometres()));
  const PlanEnd truth = ByLongDouble(ThousandKilometres());
  const Vector3 truth_m(static_cast<double>(truth.x_m), static_cast<double>(truth.y_m), 0.0);
  const AxisPoint end = line.At(line.length_m());
  const double ours_m = (end.position_m - truth_m).norm();
  const double euler_m = (ByEuler<double>(line) - truth_m.head<2>()).norm();
  const double float_m = (ByEuler<float>(line).cast<double>() - truth_m.head<2>()).norm();
  RecordRegime("the end of a line of 1,000 km",
               {"Euler's steps of 1 m: " + TwoDigits(euler_m) + " m off, in float32 " +
                    TwoDigits(float_m) + " m",
                TwoDigits(1e6 * ours_m) + " µm off"});
  EXPECT_NEAR(end.heading_rad, static_cast<double>(truth.heading_rad), 1e-12);
  EXPECT_LE(ours_m, 1e-6);
  EXPECT_GT(euler_m, 0.1);
  EXPECT_GT(float_m, 10.0);
}

}  // namespace
}  // namespace railcast
