#include "core/rail/line/line_place.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

TEST(PlaceOnLine, FindsWhereAPlaceBesideTheLineLies) {
  WorldSpec spec = CantedArc(600.0, 300.0);
  spec.alignment.speed_limits_kmph.clear();
  spec.alignment.gradients_permil = {{0.0, 12.0}};
  const Alignment alignment(spec.alignment);
  for (const double d_m : {-150.0, -4.0, 0.0, 80.0}) {
    const AxisPoint axis = alignment.At(317.0);
    const Vector3 left(-std::sin(axis.heading_rad), std::cos(axis.heading_rad), 0.0);
    const Vector3 place_m = axis.position_m + d_m * left + Vector3(0.0, 0.0, 5.5);
    const PlaceBesideLine found = PlaceOnLine(alignment, place_m, 290.0);
    // Its last step is below 1 um.
    EXPECT_NEAR(found.s_m, 317.0, 1e-6) << d_m;
    EXPECT_NEAR(found.d_m, d_m, 1e-6) << d_m;
    EXPECT_NEAR(found.h_m, 5.5, 1e-6) << d_m;
  }
}

}  // namespace
}  // namespace railcast
