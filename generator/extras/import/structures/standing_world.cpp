#include "generator/extras/import/structures/standing_world.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/structures/structures.h"
#include "core/rail/world/gauge_entries.h"
#include "core/rail/world/world_draft.h"
#include "core/scenario/descriptions.h"
#include "generator/extras/import/structures/line_structures.h"
#include "railcast/world_spec.h"

namespace railcast {
namespace {

/// Parts that are left of a structure must be as long as this.
template <class Structure>
constexpr double kShortestPart_m = 5.0;
template <>
constexpr double kShortestPart_m<TunnelSpec> = 20.0;

/// So far from what stands in a clear space it is cut.
constexpr double kClearMargin_m = 1.0;

/// What is left of a structure without some stretches of chainage.
template <class Structure>
std::vector<Structure> PartsOutside(const Structure& structure,
                                    const std::vector<ChainageRange>& stretches) {
  std::vector<Structure> parts{structure};
  for (const ChainageRange& stretch : stretches) {
    std::vector<Structure> rest;
    for (const Structure& part : parts) {
      Structure before = part;
      before.end_s_m = std::min(part.end_s_m, RoundedTo(stretch.begin_s_m - kClearMargin_m, 100.0));
      Structure behind = part;
      behind.begin_s_m =
          std::max(part.begin_s_m, RoundedTo(stretch.end_s_m + kClearMargin_m, 100.0));
      for (const Structure& piece : {before, behind}) {
        if (piece.end_s_m - piece.begin_s_m >= kShortestPart_m<Structure>) rest.push_back(piece);
      }
    }
    parts = std::move(rest);
  }
  return parts;
}

class StructureClearing {
 public:
  StructureClearing(const AlignmentSpec& alignment, LineWorld& world)
      : alignment_(alignment), world_(world) {
    spec_.alignment = alignment;
    spec_.tracks.clear();
    for (const WorldTrack& track : world.tracks) spec_.tracks.push_back(track.draft.spec);
    network_ = MakeNetwork(spec_, alignment_.length_m());
  }

  void LeaveOutFaults() {
    const std::vector<std::optional<TrackCourse>> courses(network_.courses.begin(),
                                                          network_.courses.end());
    const LineOfTracks line{{alignment_.length_m(), alignment_.tightest_radius_m()}, courses};
    std::erase_if(world_.structures, [&](const StructureSpec& structure) {
      spec_.structures = {structure};
      WorldFaults faults;
      CheckStructures(spec_, line, faults);
      if (faults.errors.empty()) return false;
      const Fault& fault = faults.errors.faults().front();
      LeaveOut(structure, "it " + fault.rule);
      return true;
    });
  }

  /// Cuts tunnels without their portals, so that portals shorten no tunnel.
  void CutOutOfClearSpaces() {
    constexpr int kMaxRounds = 6;
    std::vector<StructureSpec> open = std::exchange(world_.structures, {});
    for (int round = 0; round < kMaxRounds && !open.empty(); ++round) {
      const auto entries = EntriesOf(open, false);
      std::vector<StructureSpec> parts;
      for (std::size_t i = 0; i < open.size(); ++i) {
        const auto found = entries.find(i);
        if (found == entries.end()) {
          world_.structures.push_back(open[i]);
          continue;
        }
        std::visit(
            [&]<class Structure>(const Structure& spec) {
              if constexpr (std::is_base_of_v<StretchSpec, Structure>) {
                CutAtEntries(spec, found->second, parts);
              } else {
                LeaveOut(spec, InClearSpaceOf(found->second.front()));
              }
            },
            open[i]);
      }
      open = std::move(parts);
    }
    for (const StructureSpec& structure : open) {
      LeaveOut(structure, "what is left of it would still stand in the clear space of a track");
    }
  }

  void LeaveOutPortals() {
    std::vector<TunnelSpec*> tunnels;
    std::vector<StructureSpec> copies;
    for (StructureSpec& structure : world_.structures) {
      auto* tunnel = std::get_if<TunnelSpec>(&structure);
      if (tunnel == nullptr) continue;
      tunnels.push_back(tunnel);
      copies.push_back(structure);
    }
    for (const auto& [index, entries] : EntriesOf(copies, true)) {
      tunnels[index]->has_portals = false;
    }
  }

 private:
  static std::string InClearSpaceOf(const GaugeEntry& entry) {
    return "it would stand in the clear space of track " + entry.track;
  }

  /// Adds what is left of a structure to parts, and leaves out all else of it.
  template <class Structure>
  void CutAtEntries(const Structure& structure,
                    const std::vector<GaugeEntry>& entries,
                    std::vector<StructureSpec>& parts) {
    std::vector<ChainageRange> stretches;
    for (const GaugeEntry& entry : entries) {
      stretches.insert(stretches.end(), entry.stretches.begin(), entry.stretches.end());
    }
    double from_s_m = structure.begin_s_m;
    const auto leave_out_to = [&](double to_s_m) {
      if (to_s_m <= from_s_m) return;
      const auto entry = std::ranges::find_if(entries, [&](const GaugeEntry& one) {
        return std::ranges::any_of(one.stretches, [&](const ChainageRange& stretch) {
          return stretch.begin_s_m < to_s_m && stretch.end_s_m > from_s_m;
        });
      });
      LeaveOut(structure, InClearSpaceOf(entry == entries.end() ? entries.front() : *entry));
      world_.left_out.back().begin_s_m = from_s_m;
      world_.left_out.back().end_s_m = to_s_m;
    };
    for (const Structure& part : PartsOutside(structure, stretches)) {
      leave_out_to(part.begin_s_m);
      from_s_m = part.end_s_m;
      parts.push_back(part);
    }
    leave_out_to(structure.end_s_m);
  }

  /// What of some structures is in the clear space of tracks, by their number.
  [[nodiscard]] std::map<std::size_t, std::vector<GaugeEntry>> EntriesOf(
      const std::vector<StructureSpec>& structures, bool has_portals) {
    spec_.structures = structures;
    for (std::size_t i = 0; i < structures.size(); ++i) {
      std::visit([&](auto& spec) { spec.name = std::to_string(i); }, spec_.structures[i]);
      auto* tunnel = std::get_if<TunnelSpec>(&spec_.structures[i]);
      if (tunnel != nullptr) tunnel->has_portals = has_portals;
    }
    std::map<std::size_t, std::vector<GaugeEntry>> entries;
    for (GaugeEntry& entry : FindStructuresInGauge(spec_, alignment_, network_.courses).entries) {
      entries[std::stoul(entry.name)].push_back(std::move(entry));
    }
    return entries;
  }

  void LeaveOut(const StructureSpec& structure, const std::string& reason) {
    world_.left_out.push_back(LeftOutOf(structure, reason));
  }

  Alignment alignment_;
  LineWorld& world_;
  WorldSpec spec_;
  Network network_;
};

/// The number of an item that a pointer such as "/world/tracks/12/offset_m" leads into.
std::optional<std::size_t> ItemOf(std::string_view pointer, std::string_view list) {
  if (!pointer.starts_with(list)) return std::nullopt;
  pointer.remove_prefix(list.size());
  std::size_t item = 0;
  const auto [end, error] = std::from_chars(pointer.data(), pointer.data() + pointer.size(), item);
  return error == std::errc() ? std::optional(item) : std::nullopt;
}

std::optional<std::size_t> TrackNamed(const LineWorld& world, const std::string& name) {
  const auto found = std::ranges::find_if(
      world.tracks, [&](const WorldTrack& track) { return track.draft.spec.name == name; });
  if (found == world.tracks.end()) return std::nullopt;
  return static_cast<std::size_t>(found - world.tracks.begin());
}

ErrorList FaultsOf(const AlignmentSpec& alignment,
                   const std::optional<std::filesystem::path>& elevation,
                   const LineWorld& world) {
  WorldSpec spec;
  spec.alignment = alignment;
  spec.tracks.clear();
  for (const WorldTrack& track : world.tracks) spec.tracks.push_back(track.draft.spec);
  spec.diamond_crossings = world.crossings;
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

void ClearStructures(const AlignmentSpec& alignment, LineWorld& world) {
  if (world.structures.empty()) return;
  StructureClearing clearing(alignment, world);
  clearing.LeaveOutFaults();
  clearing.CutOutOfClearSpaces();
  clearing.LeaveOutPortals();
  NameStructures(world.structures);
}

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
      const auto crossing = ItemOf(fault.place, "/world/diamond_crossings/");
      // At a crossing, the track that came last goes.
      const auto track = crossing ? TrackNamed(world, world.crossings[*crossing].tracks.back())
                                  : ItemOf(fault.place, "/world/tracks/");
      const auto structure = ItemOf(fault.place, "/world/structures/");
      if (structure && structures.insert(*structure).second) {
        world.left_out.push_back(LeftOutOf(world.structures[*structure], reason));
      } else if (track && *track > 0 && tracks.insert(*track).second) {
        const WorldTrack& made = world.tracks[*track];
        const TrackDraft& draft = made.draft;
        const ChainageRange range =
            made.run == kUnknownSource
                ? ChainageRange{draft.course.begin_s_m(), draft.course.end_s_m()}
                : RangeInRun(world, made);
        world.left_out.push_back(
            {"track " + draft.spec.name, range.begin_s_m, range.end_s_m, reason, made.run});
      } else if (!structure && (!track || *track == 0)) {
        return errors.lines().front();
      }
    }
    for (const std::size_t track : tracks) {
      const std::string& name = world.tracks[track].draft.spec.name;
      std::erase_if(world.switches, [&](const MadeSwitch& made) {
        if (made.branch != name) return false;
        world.left_out.push_back(
            {"switch", made.s_m, made.s_m, "its branch cannot stand", made.node});
        return true;
      });
      std::erase_if(world.crossings, [&](const DiamondCrossingSpec& crossing) {
        return std::ranges::count(crossing.tracks, name) > 0;
      });
    }
    EraseNumbered(tracks, world.tracks);
    EraseNumbered(structures, world.structures);
  }
}

}  // namespace railcast
