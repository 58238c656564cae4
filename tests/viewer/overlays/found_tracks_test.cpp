#include <gtest/gtest.h>

#include <cmath>

#include "core/track/found_track.h"
#include "viewer/overlays/overlays.h"

namespace railcast {
namespace {

TEST(FoundTracks, AreDrawnAlongTheirHeadsAsFarAsTheseAreSeen) {
  FoundTrack track;
  track.track_from_sensor.translation() = Vector3(0.0, 0.3, 2.5);
  track.gauge_m.value = 1.435;
  track.curvature_per_m.value = 1.0 / 200.0;
  track.first_m = 5.0;
  track.last_m = 25.0;
  const Overlay drawing = DrawFoundTracks({track});
  EXPECT_EQ(drawing.words.size(), 5U);  // 5, 10, ... 25 m.
  ASSERT_FALSE(drawing.segments.empty());
  // The centre of its circle is 200 m to the left.
  const Eigen::Vector3d centre_m(0.0, 200.0 - 0.3, -2.5);
  for (const Overlay::Segment& segment : drawing.segments) {
    for (const Eigen::Vector3f& end_m : {segment.from_m, segment.to_m}) {
      const double from_axis_m =
          std::abs((end_m.cast<double>() - centre_m).head<2>().norm() - 200.0);
      EXPECT_NEAR(from_axis_m, 0.5 * (1.435 + kHeadWidth_m), 0.01);
      EXPECT_NEAR(end_m.z(), -2.5F, 1e-4F);
    }
  }
}

}  // namespace
}  // namespace railcast
