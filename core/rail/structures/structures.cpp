#include "core/rail/structures/structures.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "core/base/text.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structure_types.h"

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
                  const LineMeasures& line,
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

// Checks that the structure stands on ground.
void CheckExtent(const StructurePlace& place, const StructureSpec& structure, WorldFaults& faults) {
  const TrackSpec* track = FindTrack(place.world, TrackOfStructure(structure));
  const double half_width_m = place.world.terrain.half_width_m;
  if (track == nullptr || !faults.AreKnown({place.pointer})) return;
  double farthest_m = 0.0;
  for (const ClearedArea& area : ClearedAreasOf(place.world, structure)) {
    const double offset_m = TrackOffsetAt_m(*track, area.begin_s_m);
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

void CheckStructures(const WorldSpec& world, const LineMeasures& line, WorldFaults& faults) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < world.structures.size(); ++i) {
    const StructureSpec& structure = world.structures[i];
    const StructurePlace place{world, "/world/structures/" + std::to_string(i)};
    // Without a known type, nothing else of it is known either.
    if (!faults.AreKnown({place.pointer + "/type"})) continue;
    const std::string& name = NameOfStructure(structure);
    if (faults.AreKnown({place.pointer + "/name"}) && !names.insert(name).second) {
      faults.Add(place.pointer + "/name", "must be unique among the structures", Quoted(name));
    }
    if (const StretchSpec* stretch = StretchOf(structure)) {
      CheckStretch(place, *stretch, line, faults);
    }
    std::visit([&](const auto& spec) { CheckShape(place, spec, faults); }, structure);
    CheckExtent(place, structure, faults);
  }
}

}  // namespace railcast
