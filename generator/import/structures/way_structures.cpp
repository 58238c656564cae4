#include "generator/import/structures/way_structures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/rail/structures/structure_track.h"
#include "generator/import/lines/line_stretches.h"
#include "generator/import/structures/line_structures.h"

namespace railcast {
namespace {

/// What lies between two chainages of a track.
struct TaggedStretch {
  std::size_t track{};
  double begin_s_m{};
  double end_s_m{};

  [[nodiscard]] double length_m() const { return end_s_m - begin_s_m; }
};

/// By so much tags of tracks beside each other may begin and end at different chainages.
constexpr double kSameEnd_m = 15.0;
/// Shorter tunnels are not made, and shorter parts of those that strangers cut.
constexpr double kShortestTunnel_m = 5.0;
constexpr double kShortestTunnelPart_m = 20.0;
/// Tracks this close share a tunnel or a bridge (docs/world.md).
constexpr double kSharedTunnel_m = 5.5;
constexpr double kSharedBridge_m = 7.0;

using HasTag = std::function<bool(const MapTags&)>;

/// In centimetres and on the track.
std::vector<TaggedStretch> StretchesOf(const RailMap& map,
                                       const LineWorld& world,
                                       std::size_t track,
                                       const HasTag& has) {
  constexpr double kSteps_per_m = 100.0;
  const TrackCourse& course = world.tracks[track].draft.course;
  std::vector<TaggedStretch> stretches;
  for (const LineStretch& stretch : StretchesWhere(map, world.tracks[track].ways, has)) {
    const auto on_track_m = [&](double s_m) {
      const double first_m = std::ceil(course.begin_s_m() * kSteps_per_m) / kSteps_per_m;
      const double last_m = std::floor(course.end_s_m() * kSteps_per_m) / kSteps_per_m;
      return std::clamp(std::round(s_m * kSteps_per_m) / kSteps_per_m, first_m,
                        std::max(first_m, last_m));
    };
    const TaggedStretch on_track{track, on_track_m(stretch.begin_s_m), on_track_m(stretch.end_s_m)};
    if (on_track.length_m() > 0.0) stretches.push_back(on_track);
  }
  return stretches;
}

std::vector<TaggedStretch> StretchesOfAll(const RailMap& map,
                                          const LineWorld& world,
                                          const HasTag& has) {
  std::vector<TaggedStretch> all;
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    const std::vector<TaggedStretch> some = StretchesOf(map, world, i, has);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

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

/// A track that would run in a tunnel at a chainage, though the map has it outside; absent if there
/// is none.
std::optional<std::size_t> StrangerAt(double s_m,
                                      const TaggedStretch& tunnel,
                                      const TrackSpread& spread,
                                      const std::vector<TaggedStretch>& tagged,
                                      const LineWorld& world) {
  constexpr double kInside_m = 5.6;  // Of the outermost axis: the outside of the lining.
  const double own_d_m = world.tracks[tunnel.track].draft.OffsetNear_m(s_m);
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    const TrackDraft& track = world.tracks[i].draft;
    if (!track.Has(s_m)) continue;
    const double d_m = track.OffsetNear_m(s_m) - own_d_m;
    if (d_m < spread.right_m - kInside_m || d_m > spread.left_m + kInside_m) continue;
    const bool is_tagged = std::ranges::any_of(tagged, [&](const TaggedStretch& stretch) {
      return stretch.track == i && s_m > stretch.begin_s_m - kSameEnd_m &&
             s_m < stretch.end_s_m + kSameEnd_m;
    });
    if (!is_tagged) return i;
  }
  return std::nullopt;
}

void AddTunnels(const RailMap& map, LineWorld& world) {
  const std::vector<TaggedStretch> tagged = StretchesOfAll(map, world, IsTunnel);
  const SharedStretches shared(world, kSharedTunnel_m);
  for (const TaggedStretch& tunnel : shared.Of(tagged)) {
    const TrackSpread spread = shared.SpreadAt(tunnel);
    const auto stranger_at = [&](double s_m) {
      return StrangerAt(s_m, tunnel, spread, tagged, world);
    };
    const auto is_free = [&](double s_m) { return !stranger_at(s_m).has_value(); };
    for (const TaggedStretch& part :
         PartsWhere(tunnel, [&](double s_m) { return !is_free(s_m); })) {
      const std::size_t stranger =
          *stranger_at(part.begin_s_m + 0.5 * std::min(1.0, part.length_m()));
      world.left_out.push_back({"tunnel", part.begin_s_m,
                                "track " + world.tracks[stranger].draft.spec.name +
                                    ", which has none on the map, would run in it up to " +
                                    std::to_string(std::lround(part.end_s_m)) + " m"});
    }
    for (const TaggedStretch& part : PartsWhere(tunnel, is_free)) {
      const bool is_whole = part.length_m() == tunnel.length_m();
      if (part.length_m() < (is_whole ? kShortestTunnel_m : kShortestTunnelPart_m)) continue;
      AddAlong(part, TunnelSpec{}, world);
    }
  }
}

}  // namespace

bool IsTunnel(const MapTags& tags) {
  return IsThere(TagOf(tags, "tunnel")) && TagOf(tags, "tunnel") != "building_passage";
}

bool IsBridge(const MapTags& tags) {
  return IsThere(TagOf(tags, "bridge")) && !IsTunnel(tags);
}

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
