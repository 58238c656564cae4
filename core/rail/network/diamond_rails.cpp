#include "core/rail/network/junction_rails.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

/// How far the rail that guards wheels in an obtuse frog reaches beyond the tip of the planed rail.
constexpr double kObtuseGuard_m = 1.5;

/// One of the four rails of a diamond. It passes its acute frog and then its obtuse one: with
/// rising chainage, or with falling chainage.
class CrossedRail {
 public:
  CrossedRail(const DiamondCourses& diamond, bool on_second, bool is_left)
      : frog_(AcuteFrog(diamond, on_second, is_left)) {}

  [[nodiscard]] std::optional<CrossedRailPlaces> Places() const {
    const auto spread_m = [&](double s_m) { return frog_.Spread_m(s_m); };
    const auto obtuse_m = [&](double s_m) { return frog_.SpreadBeside_m(s_m); };
    const double middle_s_m = frog_.from_s_m;
    const double onwards = IsRising() ? 1.0 : -1.0;
    const auto outwards = [&](double value_m) {
      return Where(spread_m, value_m, middle_s_m, -onwards);
    };
    // In the middle, the obtuse frog is decimetres away.
    constexpr double kBeside_m = 1.0;
    const auto before = [&](double value_m) {
      return Where(obtuse_m, value_m, middle_s_m + onwards * kBeside_m, -onwards);
    };
    const auto behind = [&](double value_m) {
      return Where(obtuse_m, value_m, middle_s_m - onwards * kBeside_m, onwards);
    };
    const std::array<std::optional<double>, 8> found = {outwards(-kNoseSpread_m),
                                                        outwards(-kNoseTipWidth_m),
                                                        outwards(0.0),
                                                        outwards(kFrogFlangeway_m),
                                                        before(kNoseSpread_m),
                                                        before(kFrogFlangeway_m + kNoseTipWidth_m),
                                                        before(0.0),
                                                        behind(-kNoseSpread_m)};
    if (!std::ranges::all_of(found, [](const auto& place) { return place.has_value(); })) {
      return std::nullopt;
    }
    return CrossedRailPlaces{*found[0], *found[1], *found[2], *found[3],
                             *found[4], *found[5], *found[6], *found[7]};
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
  /// The chainage nearest to `from_s_m` on one side where the spread has a value, to 0.1 um.
  static std::optional<double> Where(const std::function<double(double)>& spread_m,
                                     double value_m,
                                     double from_s_m,
                                     double side) {
    constexpr double kStep_m = 0.5;
    constexpr double kExact_m = 1e-7;
    const bool is_above = spread_m(from_s_m) > value_m;
    double near_m = 0.0;
    double far_m = 0.0;
    do {
      near_m = far_m;
      far_m += kStep_m;
      if (far_m > kDiamondReach_m) return std::nullopt;
    } while ((spread_m(from_s_m + side * far_m) > value_m) == is_above);
    while (far_m - near_m > kExact_m) {
      const double middle_m = std::midpoint(near_m, far_m);
      ((spread_m(from_s_m + side * middle_m) > value_m) == is_above ? near_m : far_m) = middle_m;
    }
    return from_s_m + side * far_m;
  }

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
