#include "core/rail/network/junction_rails.h"

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

static_assert(kBearerSpread_m == 2.0 * kSleeperHalfLength_m + 0.1);

/// Deflection of a blade that is clamped at its heel and pulled at its tip, from 1 to 0.
double BladeShape(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  return 1.0 - 1.5 * t + 0.5 * t * t * t;
}

/// One of the two inner rails of a turnout, from its blade to behind the frog. Distances count
/// along the turnout, from its beginning on, whichever way it opens.
class InnerRail {
 public:
  InnerRail(const TurnoutCourses& turnout, bool follows_branch)
      : frog_(FrogOfRail(turnout, follows_branch)),
        length_m_(std::abs(turnout.site.end_s_m - turnout.site.s_m)),
        is_open_(follows_branch != (turnout.site.position == TurnoutPosition::kDiverging)) {}

  [[nodiscard]] const FrogRail& frog() const { return frog_; }

  void AddTo(std::vector<TurnoutRail>& rails) const {
    const double tip_m = WhereStockSpreads_m(kBladeTipWidth_m);
    const double heel_m = WhereStockSpreads_m(kHeelSpread_m);
    const double throat_m = WhereFrogSpreads_m(kFrogFlangeway_m);
    const double nose_m = WhereFrogSpreads_m(-kNoseTipWidth_m);
    rails.push_back(Blade(tip_m, heel_m));
    rails.push_back(
        frog_.Piece(RailRole::kClosure, frog_.ChainageOf_m(heel_m), frog_.ChainageOf_m(throat_m)));
    rails.push_back(frog_.Wing(throat_m, nose_m + kWingBeyondNose_m));
    rails.push_back(frog_.Nose(nose_m, WhereFrogSpreads_m(-kNoseSpread_m)));
  }
  /// From the beginning of the turnout to where the rail is whole again.
  [[nodiscard]] ChainageRange Extent() const {
    return frog_.FramesBetween(0.0, WhereFrogSpreads_m(-kNoseSpread_m));
  }
  /// Distance at which the gauge lines are that far apart in the frog, positive in front of it.
  [[nodiscard]] double WhereFrogSpreads_m(double value_m) const {
    return Where_m([&](double s_m) { return frog_.Spread_m(s_m); }, value_m);
  }

 private:
  static FrogRail FrogOfRail(const TurnoutCourses& turnout, bool follows_branch) {
    const TrackCourse& own = follows_branch ? turnout.branch : turnout.through;
    const TrackCourse& other = follows_branch ? turnout.through : turnout.branch;
    // The rail on the branch's side of the through track, and on the other one of the branch.
    const bool is_left = (turnout.site.side == TrackSide::kLeft) != follows_branch;
    return {.own = {own, is_left},
            .other = {other, !is_left},
            .beside = {other, is_left},
            .follows_branch = follows_branch,
            .is_left = is_left,
            .from_s_m = turnout.site.s_m,
            .opens_ahead = turnout.site.opens_ahead()};
  }

  /// Distance along the turnout at which a spread that changes monotonically passes `value_m`;
  /// the turnout's end if it never does.
  template <class Spread>
  [[nodiscard]] double Where_m(const Spread& spread_m, double value_m) const {
    double low_m = 0.0;
    double high_m = length_m_;
    const bool rises = spread_m(frog_.ChainageOf_m(high_m)) > spread_m(frog_.ChainageOf_m(low_m));
    constexpr int kNumHalvings = 60;
    for (int i = 0; i < kNumHalvings; ++i) {
      const double middle_m = 0.5 * (low_m + high_m);
      ((spread_m(frog_.ChainageOf_m(middle_m)) < value_m) == rises ? low_m : high_m) = middle_m;
    }
    return high_m;
  }
  [[nodiscard]] double WhereStockSpreads_m(double value_m) const {
    return Where_m([&](double s_m) { return frog_.SpreadBeside_m(s_m); }, value_m);
  }

  [[nodiscard]] TurnoutRail Blade(double tip_m, double heel_m) const {
    TurnoutRail blade =
        frog_.Piece(RailRole::kBlade, frog_.ChainageOf_m(tip_m), frog_.ChainageOf_m(heel_m));
    frog_.ShowEnd(blade, false);
    blade.width_m = [frog = frog_](double s_m) {
      return std::max(kBladeTipWidth_m, frog.SpreadBeside_m(frog.own.At(s_m).s_m));
    };
    if (!is_open_) return blade;
    blade.aside_m = [frog = frog_, tip_m, heel_m](double s_m) {
      const double along_m = frog.AlongOf_m(frog.own.At(s_m).s_m);
      return frog.OpenSide() * kBladeOpening_m * BladeShape((along_m - tip_m) / (heel_m - tip_m));
    };
    return blade;
  }

  FrogRail frog_;
  double length_m_;
  bool is_open_;  ///< Whether its blade stands off the stock rail.
};

/// Distance along the turnout from which the tracks' own sleepers fit side by side; no farther than
/// half way along the branch, from where the turnout at its other end counts.
double BearersEnd_m(const TurnoutCourses& turnout) {
  const TurnoutSite& site = turnout.site;
  const double half_m = 0.5 * (turnout.branch.end_s_m() - turnout.branch.begin_s_m());
  double along_m = 0.0;
  while (along_m < half_m) {
    const double s_m = site.opens_ahead() ? site.s_m + along_m : site.s_m - along_m;
    if (std::abs(turnout.branch.OffsetAt(s_m).d_m - turnout.through.OffsetAt(s_m).d_m) >=
        kBearerSpread_m) {
      break;
    }
    along_m += kSleeperSpacing_m;
  }
  return std::min(along_m, half_m);
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

ChainageRange GaugeLine::FramesBetween(double one_s_m, double other_s_m) const {
  const double first_m = FrameAt_m(one_s_m);
  const double last_m = FrameAt_m(other_s_m);
  return {.begin_s_m = std::min(first_m, last_m), .end_s_m = std::max(first_m, last_m)};
}

TurnoutRail FrogRail::Piece(RailRole role, double one_s_m, double other_s_m) const {
  return {.role = role,
          .follows_branch = follows_branch,
          .is_left = is_left,
          .range = own.FramesBetween(one_s_m, other_s_m),
          .aside_m = [](double) { return 0.0; },
          .width_m = [](double) { return kWhole_m; }};
}

void FrogRail::ShowEnd(TurnoutRail& rail, bool is_far_end) const {
  (opens_ahead == is_far_end ? rail.ends_openly : rail.begins_openly) = true;
}

TurnoutRail FrogRail::Wing(double throat_m, double end_m) const {
  TurnoutRail wing = Piece(RailRole::kWing, ChainageOf_m(throat_m), ChainageOf_m(end_m));
  wing.follows_branch = !follows_branch;
  wing.range = other.FramesBetween(ChainageOf_m(throat_m), ChainageOf_m(end_m));
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
  TurnoutRail nose = Piece(RailRole::kNose, ChainageOf_m(nose_m), ChainageOf_m(end_m));
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

FrogPoint FrogOf(const TurnoutCourses& turnout) {
  const InnerRail through(turnout, false);
  const InnerRail branch(turnout, true);
  const double plane_s_m = through.frog().ChainageOf_m(through.WhereFrogSpreads_m(0.0));
  FrogPoint frog{.through_s_m = through.frog().own.FrameAt_m(plane_s_m),
                 .branch_s_m = branch.frog().own.FrameAt_m(plane_s_m)};
  frog.angle_rad = std::abs(std::atan(turnout.branch.OffsetAt(frog.branch_s_m).slope) -
                            std::atan(turnout.through.OffsetAt(frog.through_s_m).slope));
  return frog;
}

std::vector<TurnoutRail> RailsOf(const TurnoutCourses& turnout) {
  std::vector<TurnoutRail> rails;
  for (const bool follows_branch : {false, true}) InnerRail(turnout, follows_branch).AddTo(rails);
  return rails;
}

std::vector<CheckRail> CheckRailsOf(const TurnoutCourses& turnout) {
  const InnerRail through(turnout, false);
  const InnerRail branch(turnout, true);
  const double nose_m = through.WhereFrogSpreads_m(-kNoseTipWidth_m);
  return {through.frog().CheckRailOpposite(nose_m), branch.frog().CheckRailOpposite(nose_m)};
}

TurnoutExtent ExtentOf(const TurnoutCourses& turnout) {
  const InnerRail through(turnout, false);
  const double from_s_m = turnout.site.s_m;
  const double to_s_m = through.frog().ChainageOf_m(BearersEnd_m(turnout));
  return {
      .through_rail = through.Extent(),
      .branch_rail = InnerRail(turnout, true).Extent(),
      .bearers = {.begin_s_m = std::min(from_s_m, to_s_m), .end_s_m = std::max(from_s_m, to_s_m)}};
}

std::vector<LaidTurnout> LayTurnouts(const Network& network) {
  std::vector<LaidTurnout> turnouts;
  for (const TurnoutSite& site : network.turnouts) {
    const TurnoutCourses courses{site, network.courses[site.track], network.courses[site.branch]};
    turnouts.push_back({site, ExtentOf(courses)});
  }
  return turnouts;
}

}  // namespace railcast
