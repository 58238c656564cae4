#include "core/rail/network/junction_rails.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace railcast {
namespace {

/// How far the rail that guards wheels in an obtuse frog reaches beyond the tip of the planed rail.
constexpr double kObtuseGuard_m = 1.5;

/// Seeks places at which a spread has given values, from one chainage on to one side.
class SpreadWalk {
 public:
  SpreadWalk(std::function<double(double)> spread_m, double from_s_m, double side)
      : spread_m_(std::move(spread_m)), from_s_m_(from_s_m), side_(side) {}

  /// The nearest chainage where the spread has a value, to 0.1 um.
  [[nodiscard]] std::optional<double> Where(double value_m) {
    const bool is_above = StepSpread_m(0) > value_m;
    std::size_t step = 1;
    while ((StepSpread_m(step) > value_m) == is_above) {
      ++step;
      if (static_cast<double>(step) * kStep_m > kDiamondReach_m) return std::nullopt;
    }
    // The spread is nearly linear within a step: a few chords lead to the two parts between which
    // it has the value.
    constexpr int kParts = 1 << 23;
    constexpr int kMostChords = 8;
    const double begin_m = static_cast<double>(step - 1) * kStep_m;
    const auto along_m = [&](int part) { return begin_m + part * (kStep_m / kParts); };
    int near = 0;
    int far = kParts;
    double near_m = StepSpread_m(step - 1) - value_m;
    double far_m = StepSpread_m(step) - value_m;
    for (int num_tried = 0; far - near > 1; ++num_tried) {
      const double share = num_tried < kMostChords ? near_m / (near_m - far_m) : 0.5;
      const int part =
          std::clamp(near + static_cast<int>(std::lround(share * (far - near))), near + 1, far - 1);
      const double part_m = spread_m_(from_s_m_ + side_ * along_m(part)) - value_m;
      const bool is_near = (part_m > 0.0) == is_above;
      (is_near ? near : far) = part;
      (is_near ? near_m : far_m) = part_m;
    }
    return from_s_m_ + side_ * along_m(far);
  }

 private:
  static constexpr double kStep_m = 0.5;

  double StepSpread_m(std::size_t step) {
    while (spreads_m_.size() <= step) {
      const double along_m = static_cast<double>(spreads_m_.size()) * kStep_m;
      spreads_m_.push_back(spread_m_(from_s_m_ + side_ * along_m));
    }
    return spreads_m_[step];
  }

  std::function<double(double)> spread_m_;
  double from_s_m_;
  double side_;
  std::vector<double> spreads_m_;  ///< At steps from `from_s_m_` on, as far as they were needed.
};

/// One of the four rails of a diamond. It passes its acute frog and then its obtuse one: with
/// rising chainage, or with falling chainage.
class CrossedRail {
 public:
  CrossedRail(const DiamondCourses& diamond, bool on_second, bool is_left)
      : frog_(AcuteFrog(diamond, on_second, is_left)) {}

  [[nodiscard]] std::optional<CrossedRailPlaces> Places() const {
    const double middle_s_m = frog_.from_s_m;
    const double onwards = IsRising() ? 1.0 : -1.0;
    // In the middle, the obtuse frog is decimetres away.
    constexpr double kBeside_m = 1.0;
    const auto obtuse_m = [&](double s_m) { return frog_.SpreadBeside_m(s_m); };
    SpreadWalk outwards([&](double s_m) { return frog_.Spread_m(s_m); }, middle_s_m, -onwards);
    SpreadWalk before(obtuse_m, middle_s_m + onwards * kBeside_m, -onwards);
    SpreadWalk behind(obtuse_m, middle_s_m - onwards * kBeside_m, onwards);
    const std::array<std::pair<SpreadWalk*, double>, 8> sought = {
        {{&outwards, -kNoseSpread_m},
         {&outwards, -kNoseTipWidth_m},
         {&outwards, 0.0},
         {&outwards, kFrogFlangeway_m},
         {&before, kNoseSpread_m},
         {&before, kFrogFlangeway_m + kNoseTipWidth_m},
         {&before, 0.0},
         {&behind, -kNoseSpread_m}}};
    std::array<double, 8> found{};
    for (std::size_t i = 0; i < sought.size(); ++i) {
      const std::optional<double> place = sought[i].first->Where(sought[i].second);
      if (!place) return std::nullopt;
      found[i] = *place;
    }
    return CrossedRailPlaces{found[0], found[1], found[2], found[3],
                             found[4], found[5], found[6], found[7]};
  }

  void AddTo(std::vector<TurnoutRail>& rails) const {
    const CrossedRailPlaces places = KnownPlaces();
    const double nose_m = frog_.AlongOf_m(places.nose_s_m);
    rails.push_back(frog_.Nose(nose_m, frog_.AlongOf_m(places.whole_s_m)));
    rails.push_back(frog_.Wing(frog_.AlongOf_m(places.throat_s_m), nose_m + kWingBeyondNose_m));
    rails.push_back(frog_.Piece(RailRole::kClosure, places.throat_s_m, places.planed_s_m));
    TurnoutRail planed = frog_.Piece(RailRole::kNose, places.planed_s_m, places.tip_s_m);
    frog_.ShowEnd(planed, false);
    planed.width_m = [frog = frog_](double s_m) {
      const double spread_m = frog.SpreadBeside_m(frog.own.At(s_m).s_m);
      return std::max(kNoseTipWidth_m, spread_m - kFrogFlangeway_m);
    };
    rails.push_back(std::move(planed));
    // Half of the knuckle, which the other track's rail continues on the other side.
    TurnoutRail knuckle = frog_.Piece(RailRole::kWing, places.obtuse_s_m, places.clear_s_m);
    frog_.ShowEnd(knuckle, true);
    rails.push_back(std::move(knuckle));
  }

  void AddTo(std::vector<CheckRail>& rails) const {
    const CrossedRailPlaces places = KnownPlaces();
    rails.push_back(frog_.CheckRailOpposite(frog_.AlongOf_m(places.nose_s_m)));
    // Two of them meet in each obtuse frog, below the knuckle.
    const double from_s_m = places.tip_s_m + (IsRising() ? -kObtuseGuard_m : kObtuseGuard_m);
    rails.push_back({.follows_branch = frog_.follows_branch,
                     .is_left = frog_.is_left,
                     .range = frog_.own.FramesBetween(from_s_m, places.obtuse_s_m),
                     .flangeway_m = kFrogFlangeway_m,
                     .flares_at_begin = IsRising(),
                     .flares_at_end = !IsRising()});
  }

  [[nodiscard]] ChainageRange Extent() const {
    const CrossedRailPlaces places = KnownPlaces();
    return frog_.own.FramesBetween(places.whole_s_m, places.clear_s_m);
  }

 private:
  [[nodiscard]] CrossedRailPlaces KnownPlaces() const {
    const std::optional<CrossedRailPlaces> places = Places();
    Check(places.has_value(), "a diamond's rails have been checked");
    return *places;
  }

  static FrogRail AcuteFrog(const DiamondCourses& diamond, bool on_second, bool is_left) {
    const TrackCourse& own = on_second ? diamond.second : diamond.first;
    const TrackCourse& other = on_second ? diamond.first : diamond.second;
    return {.own = {own, is_left},
            .other = {other, !is_left},
            .beside = {other, is_left},
            .follows_branch = on_second,
            .is_left = is_left,
            .from_s_m = diamond.site.s_m,
            // The first track comes from the right. Its left rail therefore meets the other track
            // first, and distances count against the direction in which a rail passes its frogs.
            .opens_ahead = on_second == is_left};
  }

  [[nodiscard]] bool IsRising() const { return !frog_.opens_ahead; }

  FrogRail frog_;
};

std::array<CrossedRail, 4> FourRails(const DiamondCourses& diamond) {
  return {CrossedRail(diamond, false, false), CrossedRail(diamond, false, true),
          CrossedRail(diamond, true, false), CrossedRail(diamond, true, true)};
}

/// The chainages about the middle at which the tracks' sleepers do not fit side by side.
ChainageRange BearersOf(const DiamondCourses& diamond) {
  const auto reach_s_m = [&](double side) {
    double s_m = diamond.site.s_m;
    while (std::abs(diamond.second.OffsetAt(s_m).d_m - diamond.first.OffsetAt(s_m).d_m) <
               kBearerSpread_m &&
           std::abs(s_m - diamond.site.s_m) < kDiamondReach_m) {
      s_m += side * 0.5;
    }
    return s_m;
  };
  const double begin_s_m = std::max(diamond.first.begin_s_m(), diamond.second.begin_s_m());
  const double end_s_m = std::min(diamond.first.end_s_m(), diamond.second.end_s_m());
  return {.begin_s_m = std::max(begin_s_m, reach_s_m(-1.0)),
          .end_s_m = std::min(end_s_m, reach_s_m(1.0))};
}

}  // namespace

std::optional<CrossedRailPlaces> PlacesOn(const DiamondCourses& diamond,
                                          bool on_second,
                                          bool is_left) {
  return CrossedRail(diamond, on_second, is_left).Places();
}

std::vector<TurnoutRail> RailsOf(const DiamondCourses& diamond) {
  std::vector<TurnoutRail> rails;
  for (const CrossedRail& rail : FourRails(diamond)) rail.AddTo(rails);
  return rails;
}

std::vector<CheckRail> CheckRailsOf(const DiamondCourses& diamond) {
  std::vector<CheckRail> rails;
  for (const CrossedRail& rail : FourRails(diamond)) rail.AddTo(rails);
  return rails;
}

std::vector<LaidDiamond> LayDiamonds(const Network& network) {
  std::vector<LaidDiamond> diamonds;
  for (const DiamondSite& site : network.diamonds) {
    const DiamondCourses courses{site, network.courses[site.first], network.courses[site.second]};
    const std::array<CrossedRail, 4> rails = FourRails(courses);
    diamonds.push_back({site,
                        {.first_rails = {rails[0].Extent(), rails[1].Extent()},
                         .second_rails = {rails[2].Extent(), rails[3].Extent()},
                         .bearers = BearersOf(courses)}});
  }
  return diamonds;
}

}  // namespace railcast
