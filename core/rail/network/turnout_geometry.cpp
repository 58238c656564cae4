#include "core/rail/network/turnout_geometry.h"

#include <cmath>

#include "core/base/error.h"

namespace railcast {
namespace {

/// A turnout that ends where its arc does.
TurnoutGeometry ArcToTheEnd(double radius_m, double run) {
  const double angle_rad = std::atan(1.0 / run);
  const double tangent_m = radius_m * std::tan(0.5 * angle_rad);
  return {radius_m, angle_rad, tangent_m, 2.0 * tangent_m};
}

}  // namespace

TurnoutGeometry GeometryOf(TurnoutType type) {
  switch (type) {
    case TurnoutType::k9_190: {
      TurnoutGeometry geometry = ArcToTheEnd(190.0, 9.0);
      geometry.length_m = geometry.tangent_m + ArcToTheEnd(300.0, 9.0).tangent_m;
      return geometry;
    }
    case TurnoutType::k9_300:
      return ArcToTheEnd(300.0, 9.0);
    case TurnoutType::k12_500:
      return ArcToTheEnd(500.0, 12.0);
    case TurnoutType::k14_760:
      return ArcToTheEnd(760.0, 14.0);
  }
  Check(false, "the type is one of the enumeration");
  return {};
}

}  // namespace railcast
