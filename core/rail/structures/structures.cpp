#include "core/rail/structures/structures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/network/world_tracks.h"
#include "core/rail/structures/lineside_models.h"

namespace railcast {
namespace {

const std::string& NameOfStructure(const StructureSpec& structure) {
  return std::visit([](const auto& spec) -> const std::string& { return spec.name; }, structure);
}

const std::string& TrackOfStructure(const StructureSpec& structure) {
  return std::visit([](const auto& spec) -> const std::string& { return spec.track; }, structure);
}

// Checks that both ends lie on the track.
void CheckStretch(const StructurePlace& place,
                  const StretchSpec& stretch,
                  const LineOfTracks& line,
                  WorldFaults& faults) {
  const std::string track = place.pointer + "/track";
  CheckTrackPlace(place.world,
                  {track, place.pointer + "/begin_s_m", stretch.track, stretch.begin_s_m}, line,
                  faults);
  CheckTrackPlace(place.world, {track, place.pointer + "/end_s_m", stretch.track, stretch.end_s_m},
                  line, faults);
  if (faults.AreKnown({place.pointer + "/begin_s_m", place.pointer + "/end_s_m"}) &&
      !(stretch.begin_s_m < stretch.end_s_m)) {
    faults.Add(place.pointer + "/end_s_m", "must be > begin_s_m", NumberText(stretch.end_s_m));
  }
}

// Checks that the track exists and has room for the buffer stop.
void CheckBufferStop(const StructurePlace& place,
                     const BufferStopSpec& stop,
                     const LineOfTracks& line,
                     WorldFaults& faults) {
  const TrackSpec* track = FindTrack(place.world, stop.track);
  const std::string pointer = place.pointer + "/track";
  const auto extent = track == nullptr ? std::nullopt : ExtentOf(place.world, *track, line, faults);
  const double begin_s_m = extent ? extent->begin_s_m : 0.0;
  if (CheckTrackPlace(place.world, {pointer, pointer, stop.track, begin_s_m}, line, faults) ==
          nullptr ||
      !extent || !faults.AreKnown({pointer})) {
    return;
  }
  if (stop.at == TrackTip::kEnd ? track->end.has_value() : track->begin.has_value()) {
    faults.Add(place.pointer + "/at", "must not be an end that lies in a turnout",
               Quoted(NameOf(stop.at)));
    return;
  }
  const double length_m = extent->end_s_m - begin_s_m;
  if (length_m >= kBufferStopLength_m) return;
  faults.Add(
      pointer,
      "must be at least as long as the buffer stop, " + NumberText(kBufferStopLength_m) + " m",
      Quoted(stop.track) + " of " + NumberText(length_m) + " m");
}

// Checks that the whole of a building stands beside its track.
void CheckFootprint(const StructurePlace& place,
                    const BuildingSpec& building,
                    const LineOfTracks& line,
                    WorldFaults& faults) {
  for (std::size_t i = 0; i < building.footprint_m.size(); ++i) {
    const std::string corner = place.pointer + "/footprint_m/" + std::to_string(i);
    CheckTrackPlace(place.world,
                    {place.pointer + "/track", corner, building.track, building.footprint_m[i][0]},
                    line, faults);
  }
}

/// Whether a turnout of the tracks' specs lies at some place of a range.
bool HasTurnoutIn(const WorldSpec& world, double begin_s_m, double end_s_m) {
  const auto lies_there = [&](const std::optional<TurnoutSpec>& turnout, double direction) {
    if (!turnout || !turnout->s_m) return false;
    const double end_m = *turnout->s_m + direction * GeometryOf(turnout->turnout).length_m;
    return std::min(*turnout->s_m, end_m) < end_s_m && std::max(*turnout->s_m, end_m) > begin_s_m;
  };
  return std::ranges::any_of(world.tracks, [&](const TrackSpec& track) {
    return lies_there(track.begin, 1.0) || lies_there(track.end, -1.0);
  });
}

// Checks that a road lies on its track with its whole width.
void CheckRoad(const StructurePlace& place,
               const LevelCrossingSpec& crossing,
               const LineOfTracks& line,
               WorldFaults& faults) {
  const TrackSpec* track = FindTrack(place.world, crossing.track);
  if (track == nullptr || !faults.AreKnown({place.pointer})) return;
  const auto extent = ExtentOf(place.world, *track, line, faults);
  const double half_m = 0.5 * crossing.road_width_m;
  if (HasTurnoutIn(place.world, crossing.s_m - half_m, crossing.s_m + half_m)) {
    faults.Add(place.pointer + "/s_m", "must not put the road into a turnout",
               NumberText(crossing.s_m));
    return;
  }
  if (!extent ||
      (crossing.s_m - half_m >= extent->begin_s_m && crossing.s_m + half_m <= extent->end_s_m)) {
    return;
  }
  faults.Add(place.pointer + "/s_m",
             "must be at least half the road's width of " + NumberText(crossing.road_width_m) +
                 " m from both ends of track " + Quoted(track->name),
             NumberText(crossing.s_m));
}

// Checks the chainages of any structure.
void CheckStructureChainages(const StructurePlace& place,
                             const StructureSpec& structure,
                             const LineOfTracks& line,
                             WorldFaults& faults) {
  if (const StretchSpec* stretch = StretchOf(structure)) {
    CheckStretch(place, *stretch, line, faults);
  } else if (const PointSpec* point = PointOf(structure)) {
    CheckTrackPlace(place.world,
                    {place.pointer + "/track", place.pointer + "/s_m", point->track, point->s_m},
                    line, faults);
    if (const auto* crossing = std::get_if<LevelCrossingSpec>(&structure)) {
      CheckRoad(place, *crossing, line, faults);
    }
  } else if (const auto* building = std::get_if<BuildingSpec>(&structure)) {
    CheckFootprint(place, *building, line, faults);
  } else if (const auto* stop = std::get_if<BufferStopSpec>(&structure)) {
    CheckBufferStop(place, *stop, line, faults);
  }
}

// Checks that the structure stands on ground.
void CheckGroundBelow(const StructurePlace& place,
                      const StructureSpec& structure,
                      const WorldTracks& tracks,
                      WorldFaults& faults) {
  const TrackCourse* track = tracks.CourseOf(TrackOfStructure(structure));
  const double half_width_m = place.world.terrain.half_width_m;
  if (track == nullptr || !faults.AreKnown({place.pointer})) return;
  double farthest_m = 0.0;
  for (const ClearedArea& area : ClearedAreasOf(tracks, structure)) {
    const double offset_m = track->OffsetWithin_m(area.begin_s_m);
    farthest_m =
        std::max({farthest_m, std::abs(offset_m + area.right_m), std::abs(offset_m + area.left_m)});
  }
  if (farthest_m <= half_width_m) return;
  faults.Add(place.pointer,
             "must lie, with what it clears, within the ground's half width of " +
                 NumberText(half_width_m) + " m",
             NumberText(farthest_m) + " m from the alignment");
}

}  // namespace

void AddStructures(const ChunkContext& context, Chunk& chunk) {
  for (const StructureSpec& structure : context.spec.structures) {
    std::visit([&](const auto& spec) { AddStructure(context, spec, chunk); }, structure);
  }
}

double OverhangOf_m(const StructureSpec& structure) {
  const auto* building = std::get_if<BuildingSpec>(&structure);
  if (building == nullptr) return 0.0;
  double least_m = std::numeric_limits<double>::infinity();
  double most_m = -least_m;
  for (const auto& [s_m, d_m] : building->footprint_m) {
    least_m = std::min(least_m, s_m);
    most_m = std::max(most_m, s_m);
  }
  // Its middle is in the chunk; on the outside of a curve, it is up to twice as long.
  return most_m - least_m;
}

void CheckStructures(const WorldSpec& world, const LineOfTracks& line, WorldFaults& faults) {
  std::set<std::string> names;
  std::vector<TrackCourse> courses;
  for (const std::optional<TrackCourse>& course : line.courses) {
    if (course) courses.push_back(*course);
  }
  const bool are_courses_known = courses.size() == world.tracks.size();
  for (std::size_t i = 0; i < world.structures.size(); ++i) {
    const StructureSpec& structure = world.structures[i];
    const StructurePlace place{world, "/world/structures/" + std::to_string(i)};
    // Without a known type, nothing else of it is known either.
    if (!faults.AreKnown({place.pointer + "/type"})) continue;
    const std::string& name = NameOfStructure(structure);
    if (faults.AreKnown({place.pointer + "/name"}) && !names.insert(name).second) {
      faults.Add(place.pointer + "/name", "must be unique among the structures", Quoted(name));
    }
    CheckStructureChainages(place, structure, line, faults);
    std::visit([&](const auto& spec) { CheckShape(place, spec, faults); }, structure);
    if (are_courses_known) CheckGroundBelow(place, structure, {world, courses}, faults);
  }
}

}  // namespace railcast
