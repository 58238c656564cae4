#include "generator/extras/import/structures/line_structures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/rail/network/world_tracks.h"
#include "core/rail/structures/structure_track.h"
#include "core/scenario/descriptions.h"
#include "generator/extras/import/lines/line_places.h"

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

  [[nodiscard]] std::vector<TaggedStretch> Of(std::vector<TaggedStretch> open) {
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

  /// What was not worth a structure of its own.
  [[nodiscard]] const std::vector<TaggedStretch>& short_rests() const { return short_rests_; }

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
               std::vector<TaggedStretch>& rest) {
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
      (part.length_m() > kSameEnd_m ? rest : short_rests_).push_back(part);
    }
  }

  const LineWorld& world_;
  TracksOfLine core_;
  double gap_m_;
  std::vector<TaggedStretch> short_rests_;
};

/// Where the map does not say, trams and undergrounds in tunnels have none.
bool IsBallastless(const MapTags& tags) {
  const std::string_view says = TagOf(tags, "railway:ballastless");
  if (!says.empty()) return says == "yes";
  const std::string_view railway = TagOf(tags, "railway");
  return railway == "tram" || (railway == "subway" && IsTunnel(tags));
}

template <class Structure>
void AddAlong(const TaggedStretch& stretch, Structure structure, LineWorld& world) {
  structure.track = world.tracks[stretch.track].draft.spec.name;
  structure.begin_s_m = stretch.begin_s_m;
  structure.end_s_m = stretch.end_s_m;
  world.structures.push_back(std::move(structure));
}

}  // namespace

std::vector<TaggedStretch> StretchesOfAll(const RailMap& map,
                                          const LineWorld& world,
                                          const std::function<bool(const MapTags&)>& has) {
  constexpr double kSteps_per_m = 100.0;
  std::vector<TaggedStretch> all;
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    const TrackCourse& course = world.tracks[i].draft.course;
    const double first_m = std::ceil(course.begin_s_m() * kSteps_per_m) / kSteps_per_m;
    const double last_m = std::floor(course.end_s_m() * kSteps_per_m) / kSteps_per_m;
    for (const LineStretch& stretch : StretchesWhere(map, world.tracks[i].ways, has)) {
      const auto on_track_m = [&](double s_m) {
        return std::clamp(std::round(s_m * kSteps_per_m) / kSteps_per_m, first_m,
                          std::max(first_m, last_m));
      };
      const TaggedStretch on_track{i, on_track_m(stretch.begin_s_m), on_track_m(stretch.end_s_m)};
      if (on_track.length_m() > 0.0) all.push_back(on_track);
    }
  }
  return all;
}

void AddWayStructures(const RailMap& map, LineWorld& world) {
  AddTunnels(map, world);
  SharedStretches shared(world, kSharedBridge_m);
  const std::vector<TaggedStretch> bridges = shared.Of(StretchesOfAll(map, world, IsBridge));
  for (const TaggedStretch& bridge : bridges) AddAlong(bridge, BridgeSpec{}, world);
  for (const TaggedStretch& rest : shared.short_rests()) {
    world.left_out.push_back({"bridge", rest.begin_s_m, rest.end_s_m,
                              "the bridge that it shares ends less than 15 m from its own end"});
  }
  for (const TaggedStretch& slab : StretchesOfAll(map, world, IsBallastless)) {
    AddAlong(slab, SlabTrackSpec{}, world);
  }
  const auto has_third_rail = [](const MapTags& tags) {
    return HasOneOf(TagOf(tags, "electrified"), {"rail"});
  };
  for (const TaggedStretch& stretch : StretchesOfAll(map, world, has_third_rail)) {
    ThirdRailSpec rail;
    rail.side = TrackSide::kRight;  // The map does not say.
    AddAlong(stretch, rail, world);
  }
}

void NameStructures(std::vector<StructureSpec>& structures) {
  std::map<std::string, int> num_of_type;
  for (StructureSpec& structure : structures) {
    std::visit(
        [&]<class T>(T& spec) {
          const std::string type = kTypeName<T>;
          spec.name = type + "_" + std::to_string(++num_of_type[type]);
        },
        structure);
  }
}

LeftOut LeftOutOf(const StructureSpec& structure, const std::string& reason) {
  return std::visit(
      [&]<class Structure>(const Structure& spec) -> LeftOut {
        if constexpr (std::is_base_of_v<StretchSpec, Structure>) {
          return {kTypeName<Structure>, spec.begin_s_m, spec.end_s_m, reason};
        } else if constexpr (std::is_base_of_v<PointSpec, Structure>) {
          return {kTypeName<Structure>, spec.s_m, spec.s_m, reason};
        } else {
          return {kTypeName<Structure>, 0.0, 0.0, reason};
        }
      },
      structure);
}

TracksOfLine::TracksOfLine(const LineWorld& world) {
  spec_.tracks.clear();
  for (const WorldTrack& track : world.tracks) {
    spec_.tracks.push_back(track.draft.spec);
    courses_.push_back(track.draft.course);
  }
}

void AddStructures(const RailMap& map,
                   const TrackLine& track,
                   const ImportedLine& line,
                   LineWorld& world) {
  AddWayStructures(map, world);
  const LinePlaces places(map, track, line);
  for (std::size_t i = 0; i < map.things.size(); ++i) {
    if (IsPlatform(map.things[i].tags)) AddPlatform(map.things[i], i, places, world);
  }
  for (std::size_t i = 0; i < map.things.size(); ++i) {
    if (!IsPlatform(map.things[i].tags)) AddPoint(map, i, places, world);
  }
  NameStructures(world.structures);
}

}  // namespace railcast
