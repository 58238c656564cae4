#include "core/rail/network/frog_rails.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/rail/line/rail_section.h"

namespace railcast {
namespace {

constexpr double kHalfGauge_m = 0.5 * kGauge_m;

constexpr double kWhole_m = std::numeric_limits<double>::infinity();

/// Lengths of what stands about the frog's nose, by common practice.
constexpr double kWingFlare_m = 0.4;
constexpr double kWingFlareOpening_m = 0.040;
constexpr double kCheckBefore_m = 2.2;
constexpr double kCheckBeyond_m = 1.9;

ChainageRange FramesOn(const GaugeLine& line, double one_s_m, double other_s_m) {
  const double first_m = line.FrameAt_m(one_s_m);
  const double last_m = line.FrameAt_m(other_s_m);
  return {.begin_s_m = std::min(first_m, last_m), .end_s_m = std::max(first_m, last_m)};
}

}  // namespace

GaugeLine::GaugeLine(TrackCourse course, bool is_left)
    : course_(std::move(course)), side_(is_left ? 1.0 : -1.0) {}

PlanePlace GaugeLine::At(double s_m) const {
  const TrackOffset offset = course_.OffsetAt(s_m);
  const double heading_rad = std::atan(offset.slope);
  return {s_m - side_ * kHalfGauge_m * std::sin(heading_rad),
          offset.d_m + side_ * kHalfGauge_m * std::cos(heading_rad)};
}

double GaugeLine::FrameAt_m(double plane_s_m) const {
  constexpr int kNumSteps = 8;  // Each makes the error smaller by the track's change of slope.
  double s_m = plane_s_m;
  for (int i = 0; i < kNumSteps; ++i) {
    const double next_s_m = s_m + (plane_s_m - At(s_m).s_m);
    if (next_s_m == s_m) break;  // All others would be the same, too.
    s_m = next_s_m;
  }
  return s_m;
}

double GaugeLine::LateralAt_m(double plane_s_m) const {
  return At(FrameAt_m(plane_s_m)).d_m;
}

double FrogRail::ChainageOf_m(double along_m) const {
  return opens_ahead ? from_s_m + along_m : from_s_m - along_m;
}

double FrogRail::AlongOf_m(double plane_s_m) const {
  return std::abs(plane_s_m - from_s_m);
}

double FrogRail::Spread_m(double plane_s_m) const {
  return OpenSide() * (other.LateralAt_m(plane_s_m) - own.LateralAt_m(plane_s_m));
}

ChainageRange FrogRail::FramesBetween(double from_m, double to_m) const {
  return FramesOn(own, ChainageOf_m(from_m), ChainageOf_m(to_m));
}

TurnoutRail FrogRail::Piece(RailRole role, double from_m, double to_m) const {
  return {.role = role,
          .follows_branch = follows_branch,
          .is_left = is_left,
          .range = FramesBetween(from_m, to_m),
          .aside_m = [](double) { return 0.0; },
          .width_m = [](double) { return kWhole_m; }};
}

void FrogRail::ShowEnd(TurnoutRail& rail, bool is_far_end) const {
  (opens_ahead == is_far_end ? rail.ends_openly : rail.begins_openly) = true;
}

TurnoutRail FrogRail::Wing(double throat_m, double end_m) const {
  TurnoutRail wing = Piece(RailRole::kWing, throat_m, end_m);
  wing.follows_branch = !follows_branch;
  wing.range = FramesOn(other, ChainageOf_m(throat_m), ChainageOf_m(end_m));
  ShowEnd(wing, true);
  wing.aside_m = [self = *this, end_m](double s_m) {
    const double along_m = self.AlongOf_m(self.other.At(s_m).s_m);
    const double flare = std::clamp((along_m - (end_m - kWingFlare_m)) / kWingFlare_m, 0.0, 1.0);
    // From its own side of that track to the gauge face of the other one, less the flangeway.
    return self.OpenSide() * (kGauge_m - kFrogFlangeway_m - kWingFlareOpening_m * flare);
  };
  return wing;
}

TurnoutRail FrogRail::Nose(double nose_m, double end_m) const {
  TurnoutRail nose = Piece(RailRole::kNose, nose_m, end_m);
  ShowEnd(nose, false);
  nose.width_m = [self = *this](double s_m) {
    return std::max(kNoseTipWidth_m, -self.Spread_m(self.own.At(s_m).s_m));
  };
  return nose;
}

CheckRail FrogRail::CheckRailOpposite(double nose_m) const {
  return {.follows_branch = follows_branch,
          .is_left = !is_left,
          .range = FramesBetween(nose_m - kCheckBefore_m, nose_m + kCheckBeyond_m)};
}

}  // namespace railcast
