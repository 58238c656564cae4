#include "core/rail/network/turnout_place.h"

#include <gtest/gtest.h>

#include "core/base/units.h"

namespace railcast {
namespace {

/// Figures of the norm in millimetres, of which some are cut off instead of rounded and lengths are
/// twice the rounded tangents.
struct NormFigures {
  TurnoutType type{};
  double angle_deg{};
  double tangent_m{};
  double length_m{};
};

TEST(TurnoutGeometry, HasTheLengthsAndTheAngleOfTheNorm) {
  constexpr double kMillimetre_m = 1.1e-3;
  for (const NormFigures& norm : {NormFigures{TurnoutType::k9_190, 6.3402, 10.523, 27.138},
                                  {TurnoutType::k9_300, 6.3402, 16.615, 33.230},
                                  {TurnoutType::k12_500, 4.7636, 20.797, 41.594},
                                  {TurnoutType::k14_760, 4.0856, 27.108, 54.216}}) {
    const TurnoutGeometry geometry = GeometryOf(norm.type);
    EXPECT_NEAR(DegFromRad(geometry.angle_rad), norm.angle_deg, 0.5e-4);
    EXPECT_NEAR(geometry.tangent_m, norm.tangent_m, kMillimetre_m);
    EXPECT_NEAR(geometry.length_m, norm.length_m, kMillimetre_m);
  }
}

TEST(TurnoutGeometry, EndsBothAxesAtTheSameDistanceFromWhereTheirTangentsMeet) {
  for (const TurnoutType type :
       {TurnoutType::k9_190, TurnoutType::k9_300, TurnoutType::k12_500, TurnoutType::k14_760}) {
    const TurnoutGeometry geometry = GeometryOf(type);
    // The arc begins and ends at the tangent length from that point.
    EXPECT_NEAR(geometry.straight_m() + geometry.tangent_m, geometry.length_m - geometry.tangent_m,
                1e-12);
    EXPECT_GE(geometry.straight_m(), 0.0);
    EXPECT_LT(geometry.arc_m(), 2.0 * geometry.tangent_m);
  }
}

}  // namespace
}  // namespace railcast
