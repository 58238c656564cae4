#include "core/rail/network/network_draft.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/rail/line/alignment_course.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/network/world_tracks.h"

namespace railcast {
namespace {

constexpr double kSampling_m = 1.0;

void CheckExtent(const WorldSpec& world,
                 std::size_t index,
                 const TrackCourse& course,
                 WorldFaults& faults) {
  const double half_width_m = world.terrain.half_width_m;
  const double farthest_m =
      -course.least_d_m() > course.most_d_m() ? course.least_d_m() : course.most_d_m();
  if (!faults.AreKnown({"/world/terrain/half_width_m"}) || std::abs(farthest_m) < half_width_m) {
    return;
  }
  faults.Add(TrackPointer(index),
             "must lie within the ground's half width of " + NumberText(half_width_m) + " m",
             "offset " + MetresText(farthest_m));
}

/// The sections of a course whose offset changes.
std::vector<std::pair<double, double>> ChangingSections(const TrackCourse& course) {
  std::vector<std::pair<double, double>> sections;
  for (const CoursePiece& piece : course.pieces()) {
    if (piece.kind == CoursePiece::Kind::kLevel) continue;
    const double begin_s_m = std::max(piece.begin_s_m, course.begin_s_m());
    const double end_s_m = std::min(piece.end_s_m, course.end_s_m());
    if (begin_s_m < end_s_m) sections.emplace_back(begin_s_m, end_s_m);
  }
  return sections;
}

void CheckRadii(std::size_t index,
                const TrackCourse& course,
                const Alignment& alignment,
                WorldFaults& faults) {
  double tightest_m = std::numeric_limits<double>::infinity();
  double tightest_s_m = 0.0;
  for (const auto& [begin_s_m, end_s_m] : ChangingSections(course)) {
    const auto num_steps = static_cast<int>(std::ceil((end_s_m - begin_s_m) / kSampling_m));
    for (int i = 0; i <= num_steps; ++i) {
      const double s_m = std::lerp(begin_s_m, end_s_m, 1.0 * i / num_steps);
      const double radius_m = 1.0 / std::abs(course.CurvatureAt(alignment, s_m));
      if (radius_m < tightest_m) std::tie(tightest_m, tightest_s_m) = std::pair(radius_m, s_m);
    }
  }
  // The elements of a track may have the smallest radius itself.
  constexpr double kRounding = 1e-6;
  if (tightest_m >= kSmallestRadius_m * (1.0 - kRounding)) return;
  faults.Add(TrackPointer(index),
             "must have no radius below " + NumberText(kSmallestRadius_m) + " m",
             ShortText(tightest_m) + " m at " + MetresText(tightest_s_m) + " m");
}

std::vector<JoinedSection> JoinedSections(const NetworkDraft& network) {
  std::vector<JoinedSection> sections;
  for (const TurnoutSite& turnout : network.turnouts) {
    const auto& track = network.courses[turnout.track];
    const auto& branch = network.courses[turnout.branch];
    if (track && branch) sections.push_back(JoinedSectionOf(*track, *branch, turnout));
  }
  for (const DiamondSite& diamond : network.diamonds) {
    const ChainageRange close = CloseTo(diamond, network, kLeastTrackDistance_m);
    sections.push_back({diamond.first, diamond.second, close.begin_s_m, close.end_s_m});
  }
  return sections;
}

/// Chainages at which the distance of two tracks can be least: every metre where one of them
/// changes its offset, and once where both do not.
std::vector<double> DistanceSamples(const TrackCourse& one, const TrackCourse& other) {
  const double begin_s_m = std::max(one.begin_s_m(), other.begin_s_m());
  const double end_s_m = std::min(one.end_s_m(), other.end_s_m());
  std::vector<double> samples;
  if (!(begin_s_m < end_s_m)) return samples;
  samples.push_back(begin_s_m);
  if (std::isfinite(end_s_m)) samples.push_back(end_s_m);
  for (const TrackCourse* course : {&one, &other}) {
    for (const CoursePiece& piece : course->pieces()) {
      const double from_m = std::max(piece.begin_s_m, begin_s_m);
      const double to_m = std::min(piece.end_s_m, end_s_m);
      if (!(from_m < to_m)) continue;
      samples.push_back(from_m);
      if (piece.kind == CoursePiece::Kind::kLevel) {
        samples.push_back(std::isfinite(to_m) ? std::midpoint(from_m, to_m) : from_m + 1.0);
        continue;
      }
      for (double s_m = from_m + kSampling_m; s_m < to_m; s_m += kSampling_m)
        samples.push_back(s_m);
      samples.push_back(to_m);
    }
  }
  std::ranges::sort(samples);
  return samples;
}

/// Whether an entry of the crossings that has a fault may mean the two tracks: it names one of
/// them, or no track at all.
bool MayBeNamedToCross(const WorldSpec& world,
                       std::pair<std::size_t, std::size_t> pair,
                       const WorldFaults& faults) {
  for (std::size_t i = 0; i < world.diamond_crossings.size(); ++i) {
    const std::vector<std::string>& names = world.diamond_crossings[i].tracks;
    const bool has_one = std::ranges::count(names, world.tracks[pair.first].name) > 0 ||
                         std::ranges::count(names, world.tracks[pair.second].name) > 0;
    const bool has_none = std::ranges::none_of(
        names, [&](const std::string& name) { return TrackIndex(world, name).has_value(); });
    const std::string place = "/world/diamond_crossings/" + std::to_string(i);
    if ((has_one || has_none) && !faults.AreKnown({place})) return true;
  }
  return false;
}

/// Where two tracks cross, near a place at which they are close.
double CrossingNear_m(const TrackCourse& one, const TrackCourse& other, double s_m) {
  if (std::isinf(std::min(one.end_s_m(), other.end_s_m()))) return s_m;
  const std::vector<double> places_m = CrossingPlaces(one, other);
  const auto nearest =
      std::ranges::min_element(places_m, {}, [&](double at_m) { return std::abs(at_m - s_m); });
  return nearest == places_m.end() ? s_m : *nearest;
}

void CheckApart(const WorldSpec& world,
                const NetworkDraft& network,
                const std::vector<JoinedSection>& joined,
                std::pair<std::size_t, std::size_t> pair,
                WorldFaults& faults) {
  const auto closest = FindClosePlace(joined, {{pair.first, *network.courses[pair.first]},
                                               {pair.second, *network.courses[pair.second]}});
  if (!closest) return;
  if (closest->tracks_cross) {
    if (MayBeNamedToCross(world, pair, faults)) return;
    faults.Add(TrackPointer(pair.second),
               "must not cross track " + Quoted(world.tracks[pair.first].name) +
                   " without an entry of /world/diamond_crossings",
               "at " +
                   MetresText(CrossingNear_m(*network.courses[pair.first],
                                             *network.courses[pair.second], closest->s_m)) +
                   " m");
    return;
  }
  faults.Add(TrackPointer(pair.second),
             "must be at least " + NumberText(kLeastTrackDistance_m) + " m from track " +
                 Quoted(world.tracks[pair.first].name) + " where no turnout joins them",
             MetresText(closest->distance_m) + " m at " + MetresText(closest->s_m) + " m");
}

// Roads have no slabs for rails that cross.
void CheckRoads(const WorldSpec& world, const DiamondSite& diamond, WorldFaults& faults) {
  for (std::size_t i = 0; i < world.structures.size(); ++i) {
    const auto* road = std::get_if<LevelCrossingSpec>(&world.structures[i]);
    const std::string place = "/world/structures/" + std::to_string(i);
    if (road == nullptr || !faults.AreKnown({place})) continue;
    const double half_m = 0.5 * road->road_width_m;
    if (road->s_m + half_m < diamond.begin_s_m || road->s_m - half_m > diamond.end_s_m) continue;
    faults.Add(place + "/s_m",
               "must not put the road into the crossing of tracks " +
                   Quoted(world.tracks[diamond.first].name) + " and " +
                   Quoted(world.tracks[diamond.second].name) + ", " +
                   StretchText(diamond.begin_s_m, diamond.end_s_m),
               NumberText(road->s_m));
  }
}

// Every track is canted about its own axis, so that rails which cross would not be equally high.
void CheckLevel(const DiamondSite& diamond, const Alignment& alignment, WorldFaults& faults) {
  double steepest_rad = 0.0;
  for (double s_m = diamond.begin_s_m; s_m < diamond.end_s_m + kSampling_m; s_m += kSampling_m) {
    const double cant_rad = std::abs(alignment.At(std::min(s_m, diamond.end_s_m)).cant_rad);
    steepest_rad = std::max(steepest_rad, cant_rad);
  }
  if (steepest_rad <= kMostCantAtCrossing_rad) return;
  constexpr double kRailHeads_m = 1.5;
  faults.Add("/world/diamond_crossings/" + std::to_string(diamond.entry) + "/s_m",
             "must be where the line has no cant",
             NumberText(std::round(1e3 * kRailHeads_m * std::sin(steepest_rad))) + " mm");
}

}  // namespace

JoinedSection JoinedSectionOf(const TrackCourse& track,
                              const TrackCourse& branch,
                              const TurnoutSite& turnout) {
  const auto clear_s_m = ClearChainage_m(track, branch, turnout, kLeastTrackDistance_m);
  // Without such a place, the turnout at least is allowed, so that the fault is about what is
  // behind it.
  const double end_s_m = clear_s_m.value_or(turnout.end_s_m);
  return {turnout.track, turnout.branch, std::min(turnout.s_m, end_s_m),
          std::max(turnout.s_m, end_s_m)};
}

bool AreJoined(std::span<const JoinedSection> sections,
               std::size_t one,
               std::size_t other,
               double s_m) {
  std::vector<std::size_t> reached{one};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const JoinedSection& section : sections) {
      if (s_m < section.begin_s_m || s_m > section.end_s_m) continue;
      for (const auto& [from, to] :
           {std::pair(section.track, section.branch), std::pair(section.branch, section.track)}) {
        if (from != reached[i] || std::ranges::count(reached, to) > 0) continue;
        if (to == other) return true;
        reached.push_back(to);
      }
    }
  }
  return false;
}

std::optional<ClosePlace> FindClosePlace(std::span<const JoinedSection> joined,
                                         const TrackPair& pair) {
  // Tracks that are just as far apart as they must.
  constexpr double kRounding_m = 1e-6;
  const TrackCourse& one = pair.one.course;
  const TrackCourse& other = pair.other.course;
  // Their outermost offsets are sampled, so that some more is asked for.
  constexpr double kSurely_m = kLeastTrackDistance_m + 0.5;
  if (one.least_d_m() - other.most_d_m() > kSurely_m) return std::nullopt;
  if (other.least_d_m() - one.most_d_m() > kSurely_m) return std::nullopt;
  std::optional<ClosePlace> closest;
  bool is_on_left = false;
  bool is_on_right = false;
  for (const double s_m : DistanceSamples(one, other)) {
    const double left_m = one.OffsetAt(s_m).d_m - other.OffsetAt(s_m).d_m;
    const double distance_m = std::abs(left_m);
    if (distance_m >= kLeastTrackDistance_m - kRounding_m) continue;
    if (AreJoined(joined, pair.one.index, pair.other.index, s_m)) continue;
    (left_m > 0.0 ? is_on_left : is_on_right) = true;
    if (closest && closest->distance_m <= distance_m) continue;
    closest = ClosePlace{s_m, distance_m};
  }
  if (closest) closest->tracks_cross = is_on_left && is_on_right;
  return closest;
}

void CheckNetwork(const WorldSpec& world,
                  const NetworkDraft& network,
                  const std::optional<Alignment>& alignment,
                  WorldFaults& faults) {
  const auto is_own = [&](std::size_t index) { return !IsParallel(world.tracks[index]); };
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    if (!is_own(i) || !network.courses[i]) continue;
    CheckExtent(world, i, *network.courses[i], faults);
    if (alignment) CheckRadii(i, *network.courses[i], *alignment, faults);
  }
  for (const DiamondSite& diamond : network.diamonds) {
    if (alignment) CheckLevel(diamond, *alignment, faults);
    CheckRoads(world, diamond, faults);
  }
  const std::vector<JoinedSection> joined = JoinedSections(network);
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!is_own(i) && !is_own(k)) continue;
      if (!network.courses[i] || !network.courses[k]) continue;
      CheckApart(world, network, joined, {k, i}, faults);
    }
  }
}

}  // namespace railcast
