#include "core/rail/turnout/turnout_rails.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/rail_section.h"

namespace railcast {
namespace {

constexpr double kHalfGauge_m = 0.5 * kGauge_m;
constexpr double kWhole_m = std::numeric_limits<double>::infinity();

/// Lengths of what stands about the frog's nose, by common practice.
constexpr double kWingBeyondNose_m = 1.2;
constexpr double kWingFlare_m = 0.4;
constexpr double kWingFlareOpening_m = 0.040;
constexpr double kNoseSpread_m = 0.25;  ///< Where both rails are whole again behind the nose.
constexpr double kCheckBefore_m = 2.2;
constexpr double kCheckBeyond_m = 1.9;

/// Clear space between the last long bearer's length and two sleepers side by side.
constexpr double kBearerSpread_m = 2.0 * kSleeperHalfLength_m + 0.1;

/// A place in the plane of chainage and offset.
struct PlanePlace {
  double s_m{};
  double d_m{};
};

/// The gauge line of one rail of a track in the plane of chainage and offset.
class GaugeLine {
 public:
  GaugeLine(TrackCourse course, double side) : course_(std::move(course)), side_(side) {}

  /// The gauge face in the frame of the track at `s_m`.
  [[nodiscard]] PlanePlace At(double s_m) const {
    const TrackOffset offset = course_.OffsetAt(s_m);
    const double heading_rad = std::atan(offset.slope);
    return {s_m - side_ * kHalfGauge_m * std::sin(heading_rad),
            offset.d_m + side_ * kHalfGauge_m * std::cos(heading_rad)};
  }
  /// The frame of the track in which the gauge face lies at plane chainage `plane_s_m`.
  [[nodiscard]] double FrameAt_m(double plane_s_m) const {
    constexpr int kNumSteps = 8;  // Each makes the error smaller by the branch's change of slope.
    double s_m = plane_s_m;
    for (int i = 0; i < kNumSteps; ++i) s_m += plane_s_m - At(s_m).s_m;
    return s_m;
  }
  [[nodiscard]] double LateralAt_m(double plane_s_m) const { return At(FrameAt_m(plane_s_m)).d_m; }

 private:
  TrackCourse course_;
  double side_;
};

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
        through_outer_(turnout.through, -side_),
        through_inner_(turnout.through, side_),
        branch_inner_(turnout.branch, -side_),
        branch_outer_(turnout.branch, side_) {}

  /// Side of the through track to which the branch leaves: +1 left, -1 right.
  [[nodiscard]] double side() const { return side_; }
  [[nodiscard]] bool opens_ahead() const { return opens_ahead_; }
  [[nodiscard]] bool is_diverging() const { return is_diverging_; }

  [[nodiscard]] double ChainageOf_m(double along_m) const {
    return opens_ahead_ ? s_m_ + along_m : s_m_ - along_m;
  }
  [[nodiscard]] double AlongOf_m(double plane_s_m) const { return std::abs(plane_s_m - s_m_); }
  [[nodiscard]] const GaugeLine& through_inner() const { return through_inner_; }
  [[nodiscard]] const GaugeLine& branch_inner() const { return branch_inner_; }

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

/// The range between two distances along a turnout, in the frames of the track of a gauge line.
ChainageRange FramesBetween(const TurnoutPlane& plane,
                            const GaugeLine& line,
                            double from_m,
                            double to_m) {
  const double first_m = line.FrameAt_m(plane.ChainageOf_m(from_m));
  const double last_m = line.FrameAt_m(plane.ChainageOf_m(to_m));
  return {.begin_s_m = std::min(first_m, last_m), .end_s_m = std::max(first_m, last_m)};
}

/// Deflection of a blade that is clamped at its heel and pulled at its tip, from 1 to 0.
double BladeShape(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  return 1.0 - 1.5 * t + 0.5 * t * t * t;
}

/// One of the two inner rails, from its blade to behind the frog.
class InnerRail {
 public:
  InnerRail(std::shared_ptr<const TurnoutPlane> plane, bool follows_branch)
      : plane_(std::move(plane)), follows_branch_(follows_branch) {}

  void AddTo(std::vector<TurnoutRail>& rails) const {
    const double tip_m = WhereStockSpreads_m(kBladeTipWidth_m);
    const double heel_m = WhereStockSpreads_m(kHeelSpread_m);
    const double throat_m = plane_->WhereFrogSpreads_m(kFrogFlangeway_m);
    const double nose_m = plane_->WhereFrogSpreads_m(-kNoseTipWidth_m);
    rails.push_back(Blade(tip_m, heel_m));
    rails.push_back(Piece(RailRole::kClosure, heel_m, throat_m));
    rails.push_back(Wing(throat_m, nose_m + kWingBeyondNose_m));
    rails.push_back(Nose(nose_m, plane_->WhereFrogSpreads_m(-kNoseSpread_m)));
  }
  /// From the beginning of the turnout to where the rail is whole again.
  [[nodiscard]] ChainageRange Extent() const {
    return FramesBetween(*plane_, line(), 0.0, plane_->WhereFrogSpreads_m(-kNoseSpread_m));
  }

 private:
  [[nodiscard]] const GaugeLine& line() const {
    return follows_branch_ ? plane_->branch_inner() : plane_->through_inner();
  }
  [[nodiscard]] const GaugeLine& other() const {
    return follows_branch_ ? plane_->through_inner() : plane_->branch_inner();
  }
  [[nodiscard]] double StockSpread_m(double plane_s_m) const {
    return follows_branch_ ? plane_->BranchSpread_m(plane_s_m) : plane_->ThroughSpread_m(plane_s_m);
  }
  [[nodiscard]] double WhereStockSpreads_m(double value_m) const {
    return plane_->Where_m([&](double s_m) { return StockSpread_m(s_m); }, value_m);
  }
  /// Away from the rail that the blade lies against, left positive.
  [[nodiscard]] double OpenSide() const {
    return follows_branch_ ? plane_->side() : -plane_->side();
  }
  [[nodiscard]] double AlongAt_m(const GaugeLine& gauge_line, double s_m) const {
    return plane_->AlongOf_m(gauge_line.At(s_m).s_m);
  }

  [[nodiscard]] TurnoutRail Piece(RailRole role, double from_m, double to_m) const {
    return {
        .role = role,
        .follows_branch = follows_branch_,
        // The rail on the branch's side of the through track, and on the other one of the branch.
        .is_left = (plane_->side() > 0.0) != follows_branch_,
        .range = FramesBetween(*plane_, line(), from_m, to_m),
        .aside_m = [](double) { return 0.0; },
        .width_m = [](double) { return kWhole_m; }};
  }
  void ShowEnd(TurnoutRail& rail, bool is_far_end) const {
    (plane_->opens_ahead() == is_far_end ? rail.ends_openly : rail.begins_openly) = true;
  }

  [[nodiscard]] TurnoutRail Blade(double tip_m, double heel_m) const {
    TurnoutRail blade = Piece(RailRole::kBlade, tip_m, heel_m);
    ShowEnd(blade, false);
    blade.width_m = [self = *this](double s_m) {
      return std::max(kBladeTipWidth_m, self.StockSpread_m(self.line().At(s_m).s_m));
    };
    if (follows_branch_ == plane_->is_diverging()) return blade;
    blade.aside_m = [self = *this, tip_m, heel_m](double s_m) {
      const double along_m = self.AlongAt_m(self.line(), s_m);
      return self.OpenSide() * kBladeOpening_m * BladeShape((along_m - tip_m) / (heel_m - tip_m));
    };
    return blade;
  }

  /// Goes on from the throat beside the other inner rail, a flangeway off, and opens at its end. It
  /// follows the other track's course, with its own section.
  [[nodiscard]] TurnoutRail Wing(double throat_m, double end_m) const {
    TurnoutRail wing = Piece(RailRole::kWing, throat_m, end_m);
    wing.follows_branch = !follows_branch_;
    wing.range = FramesBetween(*plane_, other(), throat_m, end_m);
    ShowEnd(wing, true);
    wing.aside_m = [self = *this, end_m](double s_m) {
      const double along_m = self.AlongAt_m(self.other(), s_m);
      const double flare = std::clamp((along_m - (end_m - kWingFlare_m)) / kWingFlare_m, 0.0, 1.0);
      // From its own side of that track to the gauge face of the other one, less the flangeway.
      return self.OpenSide() * (kGauge_m - kFrogFlangeway_m - kWingFlareOpening_m * flare);
    };
    return wing;
  }

  [[nodiscard]] TurnoutRail Nose(double nose_m, double end_m) const {
    TurnoutRail nose = Piece(RailRole::kNose, nose_m, end_m);
    ShowEnd(nose, false);
    nose.width_m = [self = *this](double s_m) {
      const double spread_m = -self.plane_->FrogSpread_m(self.line().At(s_m).s_m);
      return std::max(kNoseTipWidth_m, spread_m);
    };
    return nose;
  }

  std::shared_ptr<const TurnoutPlane> plane_;
  bool follows_branch_;
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
  FrogPoint frog{.through_s_m = plane.through_inner().FrameAt_m(plane_s_m),
                 .branch_s_m = plane.branch_inner().FrameAt_m(plane_s_m)};
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
  const bool branch_is_left = turnout.site.side == TrackSide::kLeft;
  const auto range = [&](const GaugeLine& line) {
    return FramesBetween(plane, line, nose_m - kCheckBefore_m, nose_m + kCheckBeyond_m);
  };
  return {{false, !branch_is_left, range(plane.through_inner())},
          {true, branch_is_left, range(plane.branch_inner())}};
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
