#include "core/rail/line/track_course.h"

#include "tests/support/world_specs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace railcast {
namespace {

// A sum of chords of 1 m is too short by 1 / (24 R^2) of itself.
constexpr double kRadius_m = 200.0;
constexpr double kChords = 1.0 / (24.0 * kRadius_m * kRadius_m);

Alignment LeftArc(double gradient_permil) {
  AlignmentSpec spec = AlignmentOf({{ElementType::kArc, 300.0, kRadius_m}});
  spec.gradients_permil = {{0.0, gradient_permil}};
  return Alignment(spec);
}

TEST(TrackLength, IsThatOfTheTrackItselfBesideACurve) {
  for (const double offset_m : {-4.0, 0.0, 4.5}) {
    const TrackLength length(LeftArc(0.0), TrackCourse(0.0, 300.0, offset_m));
    const double metres_per_m = (kRadius_m - offset_m) / kRadius_m;
    EXPECT_NEAR(length.total_m(), 300.0 * metres_per_m, 300.0 * 1.1 * kChords);
    EXPECT_NEAR(length.UpTo(100.5), 100.5 * metres_per_m, 100.5 * 1.1 * kChords);
  }
}

TEST(TrackLength, CountsTheSlope) {
  AlignmentSpec spec = AlignmentOf({{ElementType::kStraight, 300.0, {}}});
  spec.gradients_permil = {{0.0, 40.0}};
  const TrackLength length(Alignment(spec), TrackCourse(0.0, 300.0, 0.0));
  EXPECT_NEAR(length.total_m(), 300.0 * std::hypot(1.0, 0.04), 1e-9);
}

TEST(TrackLength, MovesAlongTheTrackAndBack) {
  const TrackLength length(LeftArc(0.0), TrackCourse(0.0, 300.0, -4.0));
  const double moved_m = 14.04 * kRadius_m / (kRadius_m + 4.0);
  EXPECT_NEAR(length.MovedFrom(120.3, 14.04), 120.3 + moved_m, 1e-4);
  EXPECT_NEAR(length.MovedFrom(120.3, -14.04), 120.3 - moved_m, 1e-4);
  EXPECT_NEAR(length.MovedFrom(length.MovedFrom(120.3, 14.04), -14.04), 120.3, 1e-9);
  EXPECT_DOUBLE_EQ(length.MovedFrom(120.3, 0.0), 120.3);
}

TEST(TrackLength, GoesOnStraightBeyondTheEnds) {
  const TrackLength length(LeftArc(0.0), TrackCourse(0.0, 300.0, -4.0));
  EXPECT_NEAR(length.MovedFrom(-5.0, -10.0), -15.0, 1e-12);
  EXPECT_NEAR(length.MovedFrom(310.0, 10.0), 320.0, 1e-9);
  EXPECT_NEAR(length.MovedFrom(2.0, -length.UpTo(2.0) - 3.0), -3.0, 1e-9);
  EXPECT_NEAR(length.MovedFrom(299.0, length.total_m() - length.UpTo(299.0) + 3.0), 303.0, 1e-9);
}

}  // namespace
}  // namespace railcast
