#include "generator/import/structures/line_structures.h"

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/base/text.h"
#include "core/scenario/describe_structures.h"
#include "generator/import/lines/line_places.h"
#include "generator/import/structures/platforms.h"
#include "generator/import/structures/way_structures.h"

namespace railcast {
namespace {

constexpr double kStepsOfPlaces_per_m = 100.0;

/// A signal; absent if the map does not say what it is.
std::optional<SignalSpec> SignalOf(const MapThing& thing,
                                   const LinePlace& at,
                                   const LinePlaces& places) {
  const auto has = [&](std::string_view key) { return !TagOf(thing.tags, key).empty(); };
  SignalSpec signal;
  if (has("railway:signal:main") || has("railway:signal:combined")) {
    signal.kind = SignalKind::kMain;
  } else if (has("railway:signal:distant")) {
    signal.kind = SignalKind::kDistant;
  } else if (has("railway:signal:shunting") || has("railway:signal:minor")) {
    signal.kind = SignalKind::kShunting;
  } else {
    return std::nullopt;
  }
  const bool is_backward = TagOf(thing.tags, "railway:signal:direction") == "backward";
  const bool is_rising = places.IsForward(at.node) != is_backward;
  signal.direction = is_rising ? RunningDirection::kRising : RunningDirection::kFalling;
  if (TagOf(thing.tags, "railway:signal:position") == "left") {
    signal.side = is_rising ? TrackSide::kLeft : TrackSide::kRight;
  }
  return signal;
}

LevelCrossingSpec LevelCrossingOf(const MapThing& thing) {
  LevelCrossingSpec crossing;
  if (TagOf(thing.tags, "railway") == "crossing") {
    crossing.road_width_m = 2.0;
    crossing.barriers = BarrierState::kNone;
  } else if (TagOf(thing.tags, "crossing:barrier") == "no") {
    crossing.barriers = BarrierState::kNone;
  }
  return crossing;
}

void AddBufferStop(const LinePlace& at, const LinePlaces& places, LineWorld& world) {
  constexpr double kNearEnd_m = 20.0;
  BufferStopSpec stop;
  if (at.s_m < kNearEnd_m) {
    stop.at = TrackTip::kBegin;
  } else if (at.s_m <= places.length_m() - kNearEnd_m) {
    world.left_out.push_back({"buffer_stop", at.s_m, at.s_m, "the line goes on behind it"});
    return;
  }
  world.structures.push_back(std::move(stop));
}

void AddPoint(const MapThing& thing, const LinePlaces& places, LineWorld& world) {
  constexpr double kOnLine_m = 2.0;
  const std::optional<LinePlace> at = places.Of(thing.places_m.front(), kOnLine_m);
  if (!at) return;
  const std::string_view railway = TagOf(thing.tags, "railway");
  if (railway == "buffer_stop") return AddBufferStop(*at, places, world);
  if (std::abs(at->beyond_m) > kOnLine_m) return;
  const auto add = [&](auto structure) {
    structure.s_m = RoundedTo(at->s_m, kStepsOfPlaces_per_m);
    world.structures.push_back(std::move(structure));
  };
  if (railway == "level_crossing" || railway == "crossing") {
    add(LevelCrossingOf(thing));
  } else if (railway == "milestone") {
    BoardSpec board;
    board.kind = BoardKind::kKilometre;
    add(board);
  } else if (railway == "derail") {
    add(DerailerSpec{});
  } else if (railway == "signal") {
    const std::optional<SignalSpec> signal = SignalOf(thing, *at, places);
    if (signal) return add(*signal);
    world.left_out.push_back({"signal", at->s_m, at->s_m, "the map does not say which kind it is"});
  }
}

}  // namespace

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
  for (const MapThing& thing : map.things) {
    if (IsPlatform(thing.tags)) AddPlatform(thing, places, world);
  }
  for (const MapThing& thing : map.things) {
    if (!IsPlatform(thing.tags)) AddPoint(thing, places, world);
  }
  NameStructures(world.structures);
}

}  // namespace railcast
