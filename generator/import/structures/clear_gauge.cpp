#include "generator/import/structures/clear_gauge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/rail/line/network.h"
#include "core/rail/structures/structure_types.h"
#include "core/rail/structures/structures.h"
#include "core/rail/structures/tunnel_shape.h"
#include "core/scenario/describe_structures.h"
#include "generator/check/gauge_entries.h"
#include "generator/import/structures/line_structures.h"

namespace railcast {
namespace {

/// Parts that are left of a structure must be as long as this.
template <class Structure>
constexpr double kShortestPart_m = 5.0;
template <>
constexpr double kShortestPart_m<TunnelSpec> = 20.0;

/// So far from what stands in a gauge it is cut.
constexpr double kGaugeMargin_m = 1.0;

/// What is left of a structure without some stretches of chainage.
template <class Structure>
std::vector<StructureSpec> PartsOutside(const Structure& structure,
                                        const std::vector<GaugeEntry>& entries) {
  std::vector<Structure> parts{structure};
  for (const GaugeEntry& entry : entries) {
    std::vector<Structure> rest;
    for (const Structure& part : parts) {
      Structure before = part;
      before.end_s_m = std::min(part.end_s_m, RoundedTo(entry.begin_s_m - kGaugeMargin_m, 100.0));
      Structure behind = part;
      behind.begin_s_m = std::max(part.begin_s_m, RoundedTo(entry.end_s_m + kGaugeMargin_m, 100.0));
      for (const Structure& piece : {before, behind}) {
        if (piece.end_s_m - piece.begin_s_m >= kShortestPart_m<Structure>) rest.push_back(piece);
      }
    }
    parts = std::move(rest);
  }
  return {parts.begin(), parts.end()};
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
  void CutOutOfGauges() {
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
        for (const GaugeEntry& entry : found->second) {
          LeaveOut(open[i], "it would stand in the structure gauge of track " + entry.track +
                                " from " + NumberText(RoundedTo(entry.begin_s_m, 1.0)) + " to " +
                                NumberText(RoundedTo(entry.end_s_m, 1.0)) + " m");
        }
        std::visit(
            [&]<class Structure>(const Structure& spec) {
              if constexpr (std::is_base_of_v<StretchSpec, Structure>) {
                std::ranges::move(PartsOutside(spec, found->second), std::back_inserter(parts));
              }
            },
            open[i]);
      }
      open = std::move(parts);
    }
    for (const StructureSpec& structure : open) {
      LeaveOut(structure, "what is left of it would still stand in the gauge of a track");
    }
  }

  /// Of tunnels that reach into each other only the first stays.
  void LeaveOutTunnelsInTunnels() {
    spec_.structures = world_.structures;
    std::vector<const TunnelSpec*> tunnels;
    std::vector<StructureSpec> kept;
    for (const StructureSpec& structure : spec_.structures) {
      const auto* tunnel = std::get_if<TunnelSpec>(&structure);
      const auto meets = [&](const TunnelSpec* other) { return Meet(*tunnel, *other); };
      const auto met = tunnel == nullptr ? tunnels.end() : std::ranges::find_if(tunnels, meets);
      if (met != tunnels.end()) {
        LeaveOut(structure, "it would reach into that of track " + (*met)->track);
        continue;
      }
      if (tunnel != nullptr) tunnels.push_back(tunnel);
      kept.push_back(structure);
    }
    world_.structures = std::move(kept);
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
  /// What of some structures is in the gauge of tracks, by their number.
  [[nodiscard]] std::map<std::size_t, std::vector<GaugeEntry>> EntriesOf(
      const std::vector<StructureSpec>& structures, bool has_portals) {
    spec_.structures = structures;
    for (std::size_t i = 0; i < structures.size(); ++i) {
      std::visit([&](auto& spec) { spec.name = std::to_string(i); }, spec_.structures[i]);
      auto* tunnel = std::get_if<TunnelSpec>(&spec_.structures[i]);
      if (tunnel != nullptr) tunnel->has_portals = has_portals;
    }
    std::map<std::size_t, std::vector<GaugeEntry>> entries;
    for (GaugeEntry& entry : FindStructuresInGauge(spec_, alignment_, network_.courses)) {
      entries[std::stoul(entry.name)].push_back(std::move(entry));
    }
    return entries;
  }

  /// Whether the linings of two tunnels touch.
  [[nodiscard]] bool Meet(const TunnelSpec& one, const TunnelSpec& other) const {
    const WorldTracks tracks{spec_, network_.courses};
    const TunnelShape shape = TunnelShapeOf(tracks, one);
    const TunnelShape other_shape = TunnelShapeOf(tracks, other);
    const double reach_m =
        shape.radius_m + other_shape.radius_m + 2.0 * TunnelShape::kLiningThickness_m;
    const TrackCourse* track = tracks.CourseOf(one.track);
    const TrackCourse* other_track = tracks.CourseOf(other.track);
    const double end_s_m = std::min(one.end_s_m, other.end_s_m);
    for (double s_m = std::max(one.begin_s_m, other.begin_s_m); s_m < end_s_m; s_m += 1.0) {
      const double apart_m = track->OffsetWithin_m(s_m) + shape.spread.middle_m() -
                             other_track->OffsetWithin_m(s_m) - other_shape.spread.middle_m();
      if (std::abs(apart_m) < reach_m) return true;
    }
    return false;
  }

  void LeaveOut(const StructureSpec& structure, const std::string& reason) {
    std::visit(
        [&]<class Structure>(const Structure& spec) {
          double s_m = 0.0;
          if constexpr (std::is_base_of_v<StretchSpec, Structure>) s_m = spec.begin_s_m;
          if constexpr (std::is_base_of_v<PointSpec, Structure>) s_m = spec.s_m;
          world_.left_out.push_back({kTypeName<Structure>, s_m, reason});
        },
        structure);
  }

  Alignment alignment_;
  LineWorld& world_;
  WorldSpec spec_;
  Network network_;
};

}  // namespace

void ClearStructures(const AlignmentSpec& alignment, LineWorld& world) {
  if (world.structures.empty()) return;
  StructureClearing clearing(alignment, world);
  clearing.LeaveOutFaults();
  clearing.CutOutOfGauges();
  clearing.LeaveOutTunnelsInTunnels();
  clearing.LeaveOutPortals();
  NameStructures(world.structures);
}

}  // namespace railcast
