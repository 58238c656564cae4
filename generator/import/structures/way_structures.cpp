#include "generator/import/structures/way_structures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/rail/network/world_tracks.h"
#include "core/rail/structures/structure_track.h"
#include "generator/import/network/tagged_stretches.h"
#include "generator/import/structures/line_structures.h"
#include "generator/import/structures/tunnels.h"

namespace railcast {
namespace {

/// The runs of chainages, metre by metre, at which something holds; the ends are those of the
/// stretch where it holds there.
std::vector<TaggedStretch> PartsWhere(const TaggedStretch& stretch,
                                      const std::function<bool(double)>& holds_at) {
  std::vector<TaggedStretch> parts;
  bool goes_on = false;
  const auto num_steps = static_cast<int>(std::max(1.0, std::ceil(stretch.length_m())));
  for (int i = 0; i < num_steps; ++i) {
    const double from_m = std::min(stretch.begin_s_m + i, stretch.end_s_m);
    const double to_m = i + 1 == num_steps ? stretch.end_s_m : from_m + 1.0;
    const bool holds = holds_at(0.5 * (from_m + to_m));
    if (holds && !goes_on) parts.push_back({stretch.track, from_m, to_m});
    if (holds) parts.back().end_s_m = to_m;
    goes_on = holds;
  }
  return parts;
}

/// Takes stretches out of a list, of tracks that share a structure only one.
class SharedStretches {
 public:
  SharedStretches(const LineWorld& world, double gap_m)
      : world_(world), core_(world), gap_m_(gap_m) {}

  [[nodiscard]] std::vector<TaggedStretch> Of(std::vector<TaggedStretch> open) const {
    std::vector<TaggedStretch> taken;
    while (!open.empty()) {
      const auto next = std::ranges::max_element(open, {}, [](const TaggedStretch& stretch) {
        return std::pair(stretch.track == 0, stretch.length_m());
      });
      taken.push_back(*next);
      open.erase(next);
      std::vector<TaggedStretch> rest;
      for (const TaggedStretch& stretch : open) AddRest(stretch, taken.back(), rest);
      open = std::move(rest);
    }
    std::ranges::sort(taken, {}, [](const TaggedStretch& stretch) {
      return std::pair(stretch.track, stretch.begin_s_m);
    });
    return taken;
  }

  [[nodiscard]] TrackSpread SpreadAt(const TaggedStretch& stretch) const {
    return SpreadOf(core_.tracks(),
                    {.name = "",
                     .track = world_.tracks[stretch.track].draft.spec.name,
                     .begin_s_m = stretch.begin_s_m,
                     .end_s_m = stretch.end_s_m},
                    gap_m_);
  }

 private:
  /// Adds what a structure that was taken has no room for.
  void AddRest(const TaggedStretch& stretch,
               const TaggedStretch& taken,
               std::vector<TaggedStretch>& rest) const {
    if (stretch.track == taken.track || stretch.begin_s_m >= taken.end_s_m ||
        stretch.end_s_m <= taken.begin_s_m) {
      rest.push_back(stretch);
      return;
    }
    constexpr double kSlack_m = 0.1;  // The tracks' sharing is found at some places only.
    const TrackSpread spread = SpreadAt(taken);
    const TrackDraft& track = world_.tracks[stretch.track].draft;
    const TrackDraft& own = world_.tracks[taken.track].draft;
    const auto is_apart = [&](double s_m) {
      if (s_m < taken.begin_s_m || s_m > taken.end_s_m) return true;
      const double d_m = track.OffsetNear_m(s_m) - own.OffsetNear_m(s_m);
      return d_m < spread.right_m - kSlack_m || d_m > spread.left_m + kSlack_m;
    };
    for (const TaggedStretch& part : PartsWhere(stretch, is_apart)) {
      if (part.length_m() > kSameEnd_m) rest.push_back(part);
    }
  }

  const LineWorld& world_;
  TracksOfLine core_;
  double gap_m_;
};

template <class Structure>
void AddAlong(const TaggedStretch& stretch, Structure structure, LineWorld& world) {
  structure.track = world.tracks[stretch.track].draft.spec.name;
  structure.begin_s_m = stretch.begin_s_m;
  structure.end_s_m = stretch.end_s_m;
  world.structures.push_back(std::move(structure));
}

}  // namespace

void AddWayStructures(const RailMap& map, LineWorld& world) {
  AddTunnels(map, world);
  const std::vector<TaggedStretch> bridges =
      SharedStretches(world, kSharedBridge_m).Of(StretchesOfAll(map, world, IsBridge));
  for (const TaggedStretch& bridge : bridges) AddAlong(bridge, BridgeSpec{}, world);
  const auto is_ballastless = [](const MapTags& tags) {
    return TagOf(tags, "railway:ballastless") == "yes";
  };
  for (const TaggedStretch& slab : StretchesOfAll(map, world, is_ballastless)) {
    AddAlong(slab, SlabTrackSpec{}, world);
  }
  const auto has_third_rail = [](const MapTags& tags) {
    return TagOf(tags, "electrified") == "rail";
  };
  for (const TaggedStretch& stretch : StretchesOfAll(map, world, has_third_rail)) {
    ThirdRailSpec rail;
    rail.side = TrackSide::kRight;  // The map does not say.
    AddAlong(stretch, rail, world);
  }
}

}  // namespace railcast
