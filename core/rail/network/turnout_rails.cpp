#include "core/rail/network/turnout_rails.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/rail/line/rail_section.h"

namespace railcast {
namespace {

static_assert(kBearerSpread_m == 2.0 * kSleeperHalfLength_m + 0.1);

/// The four gauge lines of a turnout, and where they are how far apart. Distances count along the
/// turnout, from its beginning on, whichever way it opens.
class TurnoutPlane {
 public:
  explicit TurnoutPlane(const TurnoutCourses& turnout)
      : s_m_(turnout.site.s_m),
        length_m_(std::abs(turnout.site.end_s_m - turnout.site.s_m)),
        opens_ahead_(turnout.site.opens_ahead()),
        is_diverging_(turnout.site.position == TurnoutPosition::kDiverging),
        side_(SignOf(turnout.site.side)),
        through_outer_(turnout.through, side_ < 0.0),
        through_inner_(turnout.through, side_ > 0.0),
        branch_inner_(turnout.branch, side_ < 0.0),
        branch_outer_(turnout.branch, side_ > 0.0) {}

  [[nodiscard]] bool is_diverging() const { return is_diverging_; }

  [[nodiscard]] double ChainageOf_m(double along_m) const {
    return opens_ahead_ ? s_m_ + along_m : s_m_ - along_m;
  }

  /// From the through track's stock rail to the branch's blade, between gauge faces.
  [[nodiscard]] double BranchSpread_m(double plane_s_m) const {
    return side_ * (branch_inner_.LateralAt_m(plane_s_m) - through_outer_.LateralAt_m(plane_s_m));
  }
  /// From the through track's blade to the branch's stock rail.
  [[nodiscard]] double ThroughSpread_m(double plane_s_m) const {
    return side_ * (branch_outer_.LateralAt_m(plane_s_m) - through_inner_.LateralAt_m(plane_s_m));
  }
  /// From the branch's inner rail to the through track's: positive in front of the frog.
  [[nodiscard]] double FrogSpread_m(double plane_s_m) const {
    return side_ * (through_inner_.LateralAt_m(plane_s_m) - branch_inner_.LateralAt_m(plane_s_m));
  }
  /// Distance along the turnout at which a spread that changes monotonically passes `value_m`;
  /// the turnout's end if it never does.
  template <class Spread>
  [[nodiscard]] double Where_m(const Spread& spread_m, double value_m) const {
    double low_m = 0.0;
    double high_m = length_m_;
    const bool rises = spread_m(ChainageOf_m(high_m)) > spread_m(ChainageOf_m(low_m));
    constexpr int kNumHalvings = 60;
    for (int i = 0; i < kNumHalvings; ++i) {
      const double middle_m = 0.5 * (low_m + high_m);
      ((spread_m(ChainageOf_m(middle_m)) < value_m) == rises ? low_m : high_m) = middle_m;
    }
    return high_m;
  }
  /// What becomes of the inner rail of the branch or of the through track in the frog.
  [[nodiscard]] FrogRail Frog(bool follows_branch) const {
    return {.own = follows_branch ? branch_inner_ : through_inner_,
            .other = follows_branch ? through_inner_ : branch_inner_,
            .follows_branch = follows_branch,
            // The rail on the branch's side of the through track, and on the other one of the
            // branch.
            .is_left = (side_ > 0.0) != follows_branch,
            .from_s_m = s_m_,
            .opens_ahead = opens_ahead_};
  }
  [[nodiscard]] double WhereFrogSpreads_m(double value_m) const {
    return Where_m([&](double s_m) { return FrogSpread_m(s_m); }, value_m);
  }

 private:
  double s_m_;
  double length_m_;
  bool opens_ahead_;
  bool is_diverging_;
  double side_;
  GaugeLine through_outer_;
  GaugeLine through_inner_;
  GaugeLine branch_inner_;
  GaugeLine branch_outer_;
};

/// Deflection of a blade that is clamped at its heel and pulled at its tip, from 1 to 0.
double BladeShape(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  return 1.0 - 1.5 * t + 0.5 * t * t * t;
}

/// One of the two inner rails, from its blade to behind the frog.
class InnerRail {
 public:
  InnerRail(std::shared_ptr<const TurnoutPlane> plane, bool follows_branch)
      : plane_(std::move(plane)), frog_(plane_->Frog(follows_branch)) {}

  void AddTo(std::vector<TurnoutRail>& rails) const {
    const double tip_m = WhereStockSpreads_m(kBladeTipWidth_m);
    const double heel_m = WhereStockSpreads_m(kHeelSpread_m);
    const double throat_m = plane_->WhereFrogSpreads_m(kFrogFlangeway_m);
    const double nose_m = plane_->WhereFrogSpreads_m(-kNoseTipWidth_m);
    rails.push_back(Blade(tip_m, heel_m));
    rails.push_back(frog_.Piece(RailRole::kClosure, heel_m, throat_m));
    rails.push_back(frog_.Wing(throat_m, nose_m + kWingBeyondNose_m));
    rails.push_back(frog_.Nose(nose_m, plane_->WhereFrogSpreads_m(-kNoseSpread_m)));
  }
  /// From the beginning of the turnout to where the rail is whole again.
  [[nodiscard]] ChainageRange Extent() const {
    return frog_.FramesBetween(0.0, plane_->WhereFrogSpreads_m(-kNoseSpread_m));
  }

 private:
  [[nodiscard]] double StockSpread_m(double plane_s_m) const {
    return frog_.follows_branch ? plane_->BranchSpread_m(plane_s_m)
                                : plane_->ThroughSpread_m(plane_s_m);
  }
  [[nodiscard]] double WhereStockSpreads_m(double value_m) const {
    return plane_->Where_m([&](double s_m) { return StockSpread_m(s_m); }, value_m);
  }

  [[nodiscard]] TurnoutRail Blade(double tip_m, double heel_m) const {
    TurnoutRail blade = frog_.Piece(RailRole::kBlade, tip_m, heel_m);
    frog_.ShowEnd(blade, false);
    blade.width_m = [self = *this](double s_m) {
      return std::max(kBladeTipWidth_m, self.StockSpread_m(self.frog_.own.At(s_m).s_m));
    };
    if (frog_.follows_branch == plane_->is_diverging()) return blade;
    blade.aside_m = [frog = frog_, tip_m, heel_m](double s_m) {
      const double along_m = frog.AlongOf_m(frog.own.At(s_m).s_m);
      return frog.OpenSide() * kBladeOpening_m * BladeShape((along_m - tip_m) / (heel_m - tip_m));
    };
    return blade;
  }

  std::shared_ptr<const TurnoutPlane> plane_;
  FrogRail frog_;
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

FrogPoint FrogOf(const TurnoutCourses& turnout) {
  const TurnoutPlane plane(turnout);
  const double plane_s_m = plane.ChainageOf_m(plane.WhereFrogSpreads_m(0.0));
  FrogPoint frog{.through_s_m = plane.Frog(false).own.FrameAt_m(plane_s_m),
                 .branch_s_m = plane.Frog(true).own.FrameAt_m(plane_s_m)};
  frog.angle_rad = std::abs(std::atan(turnout.branch.OffsetAt(frog.branch_s_m).slope) -
                            std::atan(turnout.through.OffsetAt(frog.through_s_m).slope));
  return frog;
}

std::vector<TurnoutRail> RailsOf(const TurnoutCourses& turnout) {
  const auto plane = std::make_shared<const TurnoutPlane>(turnout);
  std::vector<TurnoutRail> rails;
  InnerRail(plane, false).AddTo(rails);
  InnerRail(plane, true).AddTo(rails);
  return rails;
}

std::vector<CheckRail> CheckRailsOf(const TurnoutCourses& turnout) {
  const TurnoutPlane plane(turnout);
  const double nose_m = plane.WhereFrogSpreads_m(-kNoseTipWidth_m);
  return {plane.Frog(false).CheckRailOpposite(nose_m), plane.Frog(true).CheckRailOpposite(nose_m)};
}

TurnoutExtent ExtentOf(const TurnoutCourses& turnout) {
  const auto plane = std::make_shared<const TurnoutPlane>(turnout);
  const double from_s_m = turnout.site.s_m;
  const double to_s_m = plane->ChainageOf_m(BearersEnd_m(turnout));
  return {
      .through_rail = InnerRail(plane, false).Extent(),
      .branch_rail = InnerRail(plane, true).Extent(),
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
