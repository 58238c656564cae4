#include "core/rail/network/network_draft.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/rail/network/junction_rails.h"
#include "core/rail/network/turnout_place.h"

namespace railcast {
namespace {

/// Finds one crossing of the list.
class DiamondFinder {
 public:
  DiamondFinder(const WorldSpec& world,
                std::size_t index,
                NetworkDraft& network,
                WorldFaults& faults)
      : world_(world),
        spec_(world.diamond_crossings[index]),
        index_(index),
        pointer_("/world/diamond_crossings/" + std::to_string(index)),
        network_(network),
        faults_(faults) {}

  void Find() {
    if (!faults_.AreKnown({pointer_}) || !AreNamesKnown(world_, faults_)) return;
    if (spec_.tracks.size() != 2) {
      faults_.Add(pointer_ + "/tracks", "must name two tracks");
      return;
    }
    const auto one = Track(0);
    const auto other = Track(1);
    if (!one || !other) return;
    if (*one == *other) {
      faults_.Add(pointer_ + "/tracks/1", "must be another track", Quoted(spec_.tracks[1]));
      return;
    }
    if (!network_.courses[*one] || !network_.courses[*other]) return;
    const std::optional<double> s_m = CrossingPlace(*one, *other);
    if (!s_m) return;
    DiamondSite site{.entry = index_, .first = *one, .second = *other, .s_m = *s_m};
    if (Course(site.first).OffsetAt(*s_m).slope < Course(site.second).OffsetAt(*s_m).slope) {
      std::swap(site.first, site.second);
    }
    if (!HasAngle(site) || !HasRoom(site)) return;
    CheckAlone(site);
    // Also if something overlaps it, so that its tracks are not reported as too close as well.
    network_.diamonds.push_back(site);
  }

 private:
  [[nodiscard]] const TrackCourse& Course(std::size_t track) const {
    return *network_.courses[track];
  }
  [[nodiscard]] std::string NamesOf(std::size_t one, std::size_t other) const {
    return Quoted(world_.tracks[one].name) + " and " + Quoted(world_.tracks[other].name);
  }

  [[nodiscard]] std::optional<std::size_t> Track(std::size_t entry) {
    const std::optional<std::size_t> track = TrackIndex(world_, spec_.tracks[entry]);
    if (!track) {
      AddUnknownTrack(world_, pointer_ + "/tracks/" + std::to_string(entry), spec_.tracks[entry],
                      faults_);
    }
    return track;
  }

  /// The crossing nearest to the given chainage.
  [[nodiscard]] std::optional<double> CrossingPlace(std::size_t one, std::size_t other) {
    constexpr double kNear_m = 5.0;
    // The line is unknown.
    if (std::isinf(std::min(Course(one).end_s_m(), Course(other).end_s_m()))) return std::nullopt;
    const std::vector<double> places_m = CrossingPlaces(Course(one), Course(other));
    const auto nearest = std::ranges::min_element(
        places_m, {}, [&](double s_m) { return std::abs(s_m - spec_.s_m); });
    if (nearest == places_m.end()) {
      faults_.Add(pointer_ + "/tracks", "must be tracks that cross", NamesOf(one, other));
      return std::nullopt;
    }
    if (std::abs(*nearest - spec_.s_m) <= kNear_m) return *nearest;
    faults_.Add(pointer_ + "/s_m",
                "must be within " + NumberText(kNear_m) + " m of where tracks " +
                    NamesOf(one, other) + " cross, at " + MetresText(*nearest) + " m",
                NumberText(spec_.s_m));
    return std::nullopt;
  }

  [[nodiscard]] bool HasAngle(DiamondSite& site) {
    constexpr double kRounding = 1e-6;
    site.angle_rad = std::atan(Course(site.first).OffsetAt(site.s_m).slope) -
                     std::atan(Course(site.second).OffsetAt(site.s_m).slope);
    const double n = 1.0 / std::tan(site.angle_rad);
    if (n >= kSteepestDiamond * (1.0 - kRounding) && n <= kFlattestDiamond * (1.0 + kRounding)) {
      return true;
    }
    faults_.Add(pointer_ + "/s_m",
                "must be where the tracks cross at an angle from 1:" +
                    NumberText(kFlattestDiamond) + " to 1:" + NumberText(kSteepestDiamond),
                "1:" + NumberText(std::round(n * 1e3) / 1e3));
    return false;
  }

  /// Whether all its rails can be laid, on both tracks.
  [[nodiscard]] bool HasRoom(DiamondSite& site) {
    const DiamondCourses courses{site, Course(site.first), Course(site.second)};
    constexpr double kCheckBeyondNose_m = 2.0;
    site.begin_s_m = site.s_m;
    site.end_s_m = site.s_m;
    for (const bool on_second : {false, true}) {
      for (const bool is_left : {false, true}) {
        const auto places = PlacesOn(courses, on_second, is_left);
        if (!places) {
          faults_.Add(pointer_ + "/s_m",
                      "must be where the tracks part again within " + NumberText(kDiamondReach_m) +
                          " m to either side",
                      NumberText(spec_.s_m));
          return false;
        }
        site.begin_s_m =
            std::min({site.begin_s_m, places->whole_s_m, places->nose_s_m - kCheckBeyondNose_m});
        site.end_s_m =
            std::max({site.end_s_m, places->whole_s_m, places->nose_s_m + kCheckBeyondNose_m});
      }
    }
    for (const std::size_t track : {site.first, site.second}) {
      if (site.begin_s_m >= Course(track).begin_s_m() && site.end_s_m <= Course(track).end_s_m()) {
        continue;
      }
      faults_.Add(pointer_ + "/s_m",
                  "must put the crossing on track " + Quoted(world_.tracks[track].name) + ", " +
                      StretchText(Course(track).begin_s_m(), Course(track).end_s_m()),
                  StretchText(site.begin_s_m, site.end_s_m));
      return false;
    }
    return true;
  }

  /// Checks that no other crossing and no turnout lies in it.
  void CheckAlone(const DiamondSite& site) {
    const auto overlaps = [&](double one_s_m, double other_s_m) {
      return std::min(one_s_m, other_s_m) < site.end_s_m &&
             std::max(one_s_m, other_s_m) > site.begin_s_m;
    };
    const auto has = [&](std::size_t track) { return track == site.first || track == site.second; };
    for (const DiamondSite& other : network_.diamonds) {
      if (!has(other.first) && !has(other.second)) continue;
      if (!overlaps(other.begin_s_m, other.end_s_m)) continue;
      faults_.Add(pointer_ + "/s_m",
                  "must not overlap the crossing of tracks " + NamesOf(other.first, other.second) +
                      ", " + StretchText(other.begin_s_m, other.end_s_m),
                  StretchText(site.begin_s_m, site.end_s_m));
      return;
    }
    for (const TurnoutSite& turnout : network_.turnouts) {
      if (!has(turnout.track) && !has(turnout.branch)) continue;
      if (!overlaps(turnout.s_m, turnout.end_s_m)) continue;
      const auto [from_m, to_m] = std::minmax(turnout.s_m, turnout.end_s_m);
      faults_.Add(pointer_ + "/s_m",
                  "must not overlap the turnout of track " +
                      Quoted(world_.tracks[turnout.branch].name) + " on track " +
                      Quoted(world_.tracks[turnout.track].name) + ", " + StretchText(from_m, to_m) +
                      " (there are no slips)",
                  StretchText(site.begin_s_m, site.end_s_m));
      return;
    }
  }

  const WorldSpec& world_;
  const DiamondCrossingSpec& spec_;
  std::size_t index_;
  std::string pointer_;
  NetworkDraft& network_;
  WorldFaults& faults_;
};

}  // namespace

void FindDiamonds(const WorldSpec& world, NetworkDraft& network, WorldFaults& faults) {
  for (std::size_t i = 0; i < world.diamond_crossings.size(); ++i) {
    DiamondFinder(world, i, network, faults).Find();
  }
}

std::vector<double> CrossingPlaces(const TrackCourse& one, const TrackCourse& other) {
  constexpr double kStep_m = 1.0;
  constexpr double kExact_m = 1e-7;
  // Places are sampled off the round chainages that people write, where the tracks' distance may be
  // exactly 0, which is no change of sign.
  constexpr double kOffRound_m = 0.381966;
  const double begin_s_m = std::max(one.begin_s_m(), other.begin_s_m());
  const double end_s_m = std::min(one.end_s_m(), other.end_s_m());
  const auto apart_m = [&](double s_m) { return one.OffsetAt(s_m).d_m - other.OffsetAt(s_m).d_m; };
  std::vector<double> places_m;
  for (double s_m = begin_s_m - kOffRound_m; s_m < end_s_m; s_m += kStep_m) {
    double low_m = std::max(begin_s_m, s_m);
    double high_m = std::min(end_s_m, s_m + kStep_m);
    // A track that begins or ends on another one does so in a turnout.
    if (apart_m(low_m) * apart_m(high_m) >= 0.0) continue;
    while (high_m - low_m > kExact_m) {
      const double middle_m = std::midpoint(low_m, high_m);
      (apart_m(middle_m) * apart_m(high_m) > 0.0 ? high_m : low_m) = middle_m;
    }
    places_m.push_back(high_m);
  }
  return places_m;
}

ChainageRange CloseTo(const DiamondSite& diamond, const NetworkDraft& network, double distance_m) {
  const TrackCourse& first = *network.courses[diamond.first];
  const TrackCourse& second = *network.courses[diamond.second];
  constexpr double kStep_m = 0.5;
  constexpr double kFarthest_m = 200.0;
  const auto reach_s_m = [&](double side, double otherwise_s_m) {
    for (double along_m = 0.0; along_m < kFarthest_m; along_m += kStep_m) {
      const double s_m = diamond.s_m + side * along_m;
      if (std::abs(first.OffsetAt(s_m).d_m - second.OffsetAt(s_m).d_m) >= distance_m) return s_m;
    }
    return otherwise_s_m;
  };
  return {.begin_s_m = reach_s_m(-1.0, diamond.begin_s_m),
          .end_s_m = reach_s_m(1.0, diamond.end_s_m)};
}

}  // namespace railcast
