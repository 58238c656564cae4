#include "core/rail/network/world_tracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/text.h"
#include "core/rail/network/turnout_place.h"

namespace railcast {
namespace {

/// How far a track is from another, left positive, where it is farthest along a stretch without
/// being more than `gap_m` away; if it always is, where it is nearest.
double FarthestWithin_m(const TrackCourse& track,
                        const TrackCourse& own,
                        const StretchSpec& stretch,
                        double gap_m) {
  const double begin_s_m = std::max(stretch.begin_s_m, track.begin_s_m());
  const double end_s_m = std::min(stretch.end_s_m, track.end_s_m());
  const bool is_parallel = track.is_parallel() && own.is_parallel();
  // A loop runs beside its track for most of its length.
  constexpr double kMostSteps = 32.0;
  const int num_steps =
      is_parallel ? 1 : static_cast<int>(std::ceil(std::min(kMostSteps, end_s_m - begin_s_m)));
  std::optional<double> within_m;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= num_steps; ++i) {
    const double s_m = std::lerp(begin_s_m, end_s_m, 1.0 * i / num_steps);
    const double d_m = track.OffsetWithin_m(s_m) - own.OffsetWithin_m(s_m);
    if (std::abs(d_m) < std::abs(nearest_m)) nearest_m = d_m;
    if (std::abs(d_m) <= gap_m && (!within_m || std::abs(d_m) > std::abs(*within_m))) {
      within_m = d_m;
    }
  }
  return within_m.value_or(nearest_m);
}

}  // namespace

const TrackSpec* FindTrack(const WorldSpec& world, const std::string& name) {
  const std::optional<std::size_t> index = TrackIndex(world, name);
  return index ? &world.tracks[*index] : nullptr;
}

TrackSpread SpreadOf(const WorldTracks& tracks, const StretchSpec& stretch, double gap_m) {
  const TrackCourse* own = tracks.CourseOf(stretch.track);
  if (own == nullptr) return {};
  std::vector<double> others_m;
  for (const TrackCourse& track : tracks.courses) {
    if (track.begin_s_m() >= stretch.end_s_m || track.end_s_m() <= stretch.begin_s_m) continue;
    others_m.push_back(FarthestWithin_m(track, *own, stretch, gap_m));
  }
  std::ranges::sort(others_m);
  TrackSpread spread;
  for (const double d_m : others_m) {
    if (d_m > spread.left_m && d_m <= spread.left_m + gap_m) spread.left_m = d_m;
  }
  for (const double d_m : std::vector<double>(others_m.rbegin(), others_m.rend())) {
    if (d_m < spread.right_m && d_m >= spread.right_m - gap_m) spread.right_m = d_m;
  }
  return spread;
}

std::string TrackPointer(const TrackSpec& track, const WorldSpec& world) {
  return TrackPointer(static_cast<std::size_t>(&track - world.tracks.data()));
}

std::optional<TrackExtent> ExtentOf(const WorldSpec& world,
                                    const TrackSpec& track,
                                    const LineOfTracks& line,
                                    const WorldFaults& faults) {
  const std::string pointer = TrackPointer(track, world);
  if (!IsParallel(track)) {
    const auto& course = line.courses[static_cast<std::size_t>(&track - world.tracks.data())];
    if (!course) return std::nullopt;
    return TrackExtent{course->begin_s_m(), course->end_s_m()};
  }
  if (!faults.AreKnown({pointer + "/start_s_m", pointer + "/end_s_m"})) return std::nullopt;
  return TrackExtent{track.start_s_m, track.end_s_m.value_or(line.measures.length_m)};
}

const TrackSpec* CheckTrackPlace(const WorldSpec& world,
                                 const TrackPlace& place,
                                 const LineOfTracks& line,
                                 WorldFaults& faults) {
  if (!faults.AreKnown({place.track_pointer})) return nullptr;
  const TrackSpec* track = FindTrack(world, place.track);
  if (track == nullptr) {
    AddUnknownTrack(world, place.track_pointer, place.track, faults);
    return nullptr;
  }
  const std::optional<TrackExtent> extent = ExtentOf(world, *track, line, faults);
  if (extent && faults.AreKnown({place.chainage_pointer}) &&
      !(place.s_m >= extent->begin_s_m && place.s_m <= extent->end_s_m)) {
    faults.Add(place.chainage_pointer,
               "must lie on track " + Quoted(track->name) + ", " +
                   StretchText(extent->begin_s_m, extent->end_s_m),
               NumberText(place.s_m));
  }
  return track;
}

void CheckFitsGauge(const WorldSpec& world, const OfStandardGauge& thing, WorldFaults& faults) {
  const double gauge_mm = world.alignment.gauge_mm;
  if (gauge_mm == kStandardGauge_mm || !faults.AreKnown({"/world/alignment/gauge_mm"})) return;
  faults.Add(thing.place,
             thing.rule + " of " + NumberText(kStandardGauge_mm) + " mm only, and gauge_mm is " +
                 NumberText(gauge_mm),
             thing.found);
}

void CheckWheelsFit(const WorldSpec& world,
                    const ObjectType& type,
                    const std::string& pointer,
                    WorldFaults& faults) {
  CheckFitsGauge(
      world,
      {pointer, "must not be a rail vehicle: they have wheels", Quoted(std::string(NameOf(type)))},
      faults);
}

}  // namespace railcast
