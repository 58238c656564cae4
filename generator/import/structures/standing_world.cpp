#include "generator/import/structures/standing_world.h"

#include <charconv>
#include <cstddef>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/rail/world/world_draft.h"
#include "generator/import/structures/line_structures.h"
#include "railcast/world_spec.h"

namespace railcast {
namespace {

/// The number of an item that a pointer such as "/world/tracks/12/offset_m" leads into.
std::optional<std::size_t> ItemOf(std::string_view pointer, std::string_view list) {
  if (!pointer.starts_with(list)) return std::nullopt;
  pointer.remove_prefix(list.size());
  std::size_t item = 0;
  const auto [end, error] = std::from_chars(pointer.data(), pointer.data() + pointer.size(), item);
  return error == std::errc() ? std::optional(item) : std::nullopt;
}

ErrorList FaultsOf(const AlignmentSpec& alignment,
                   const std::optional<std::filesystem::path>& elevation,
                   const LineWorld& world) {
  WorldSpec spec;
  spec.alignment = alignment;
  spec.tracks.clear();
  for (const WorldTrack& track : world.tracks) spec.tracks.push_back(track.draft.spec);
  spec.structures = world.structures;
  if (elevation) spec.terrain.elevation = ElevationSpec{.file = elevation->string()};
  // The scenario brings labels and materials.
  WorldFaults faults;
  faults.unknown.Add("/labels");
  faults.unknown.Add("/materials");
  static_cast<void>(DraftWorld({spec, VehicleSpec(), LabelTable(), MaterialLibrary()}, faults));
  return faults.errors;
}

/// Leaves out the items of a list with these numbers.
template <class Item>
void EraseNumbered(const std::set<std::size_t>& numbers, std::vector<Item>& items) {
  for (auto number = numbers.rbegin(); number != numbers.rend(); ++number) {
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(*number));
  }
}

}  // namespace

std::optional<std::string> MakeStand(const AlignmentSpec& alignment,
                                     const std::optional<std::filesystem::path>& elevation,
                                     LineWorld& world) {
  while (true) {
    const ErrorList errors = FaultsOf(alignment, elevation, world);
    if (errors.empty()) return std::nullopt;
    std::set<std::size_t> tracks;
    std::set<std::size_t> structures;
    for (const Fault& fault : errors.faults()) {
      const std::string reason =
          "it " + fault.rule + (fault.value.empty() ? "" : " (got " + fault.value + ")");
      const auto track = ItemOf(fault.place, "/world/tracks/");
      const auto structure = ItemOf(fault.place, "/world/structures/");
      if (structure && structures.insert(*structure).second) {
        world.left_out.push_back(LeftOutOf(world.structures[*structure], reason));
      } else if (track && *track > 0 && tracks.insert(*track).second) {
        const TrackDraft& draft = world.tracks[*track].draft;
        world.left_out.push_back(
            {"track " + draft.spec.name, draft.course.begin_s_m(), draft.course.end_s_m(), reason});
      } else if (!structure && (!track || *track == 0)) {
        return errors.lines().front();
      }
    }
    for (const std::size_t track : tracks) {
      std::erase_if(world.moved, [&](const MovedTrack& moved) {
        return moved.name == world.tracks[track].draft.spec.name;
      });
    }
    EraseNumbered(tracks, world.tracks);
    EraseNumbered(structures, world.structures);
  }
}

}  // namespace railcast
