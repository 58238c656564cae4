#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/network/line_world.h"
#include "generator/extras/import/structures/line_structures.h"

namespace railcast {
namespace {

/// A point of the map on a track of a world.
struct PlaceOnTrack {
  std::size_t track{};
  LinePlace at;
  bool is_forward{};  ///< Whether the way there is drawn with rising chainage.
};

/// Things are on tracks of which the map has the axis within this distance.
constexpr double kStandsOn_m = 2.0;

bool IsForward(const RailMap& map,
               const LineWorld& world,
               std::size_t track,
               const LinePlace& at,
               const LinePlaces& places) {
  if (track == 0) return places.IsForward(at.node);
  const TrackRun& run = world.beside.runs[world.tracks[track].run];
  std::size_t step = 0;
  while (step + 1 < run.ways.size() && run.ways[step].end_s_m < at.s_m) ++step;
  return IsDrawnForward(map, {run.ways[step].way, run.nodes[step], run.nodes[step + 1]});
}

std::optional<PlaceOnTrack> PlaceOf(const Eigen::Vector2d& place_m,
                                    const RailMap& map,
                                    const LinePlaces& places,
                                    const LineWorld& world) {
  const std::optional<LinePlace> at = places.Of(place_m, kRunStrip_m);
  if (!at) return std::nullopt;
  std::optional<std::size_t> nearest;
  double least_m = kStandsOn_m;
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    const WorldTrack& track = world.tracks[i];
    const TrackCourse& course = track.draft.course;
    if (at->s_m < course.begin_s_m() - kStandsOn_m || at->s_m > course.end_s_m() + kStandsOn_m) {
      continue;
    }
    const double off_m =
        std::abs(at->d_m - track.draft.OffsetNear_m(at->s_m) - track.OffAt_m(at->s_m));
    if (off_m > least_m) continue;
    least_m = off_m;
    nearest = i;
  }
  if (!nearest) return std::nullopt;
  return PlaceOnTrack{*nearest, *at, IsForward(map, world, *nearest, *at, places)};
}

/// A signal; absent if the map does not say what it is.
std::optional<SignalSpec> SignalOf(const MapTags& tags, bool is_forward) {
  const auto has = [&](std::string_view key) { return !TagOf(tags, key).empty(); };
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
  const bool is_backward = TagOf(tags, "railway:signal:direction") == "backward";
  const bool is_rising = is_forward != is_backward;
  signal.direction = is_rising ? RunningDirection::kRising : RunningDirection::kFalling;
  if (TagOf(tags, "railway:signal:position") == "left") {
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

/// The road of the world on which a level crossing of another track lies, too: roads cross all
/// tracks.
const LevelCrossingSpec* RoadAt(const PlaceOnTrack& place, const LineWorld& world) {
  constexpr double kSameRoad_m = 10.0;
  for (const StructureSpec& structure : world.structures) {
    const auto* road = std::get_if<LevelCrossingSpec>(&structure);
    if (road != nullptr && std::abs(road->s_m - place.at.s_m) < kSameRoad_m) return road;
  }
  return nullptr;
}

/// The end of a track at which a buffer stop is; absent if the track goes on behind it.
std::optional<TrackTip> TipAt(const PlaceOnTrack& place, const LineWorld& world) {
  constexpr double kNearEnd_m = 20.0;
  const TrackDraft& draft = world.tracks[place.track].draft;
  if (!draft.spec.begin && place.at.s_m < draft.course.begin_s_m() + kNearEnd_m) {
    return TrackTip::kBegin;
  }
  if (!draft.spec.end && place.at.s_m > draft.course.end_s_m() - kNearEnd_m) return TrackTip::kEnd;
  return std::nullopt;
}

}  // namespace

void AddPoint(const RailMap& map, std::size_t number, const LinePlaces& places, LineWorld& world) {
  const MapThing& thing = map.things[number];
  const auto place = PlaceOf(thing.places_m.front(), map, places, world);
  if (!place) return;
  const std::string_view railway = TagOf(thing.tags, "railway");
  const auto add = [&](auto structure) {
    structure.track = world.tracks[place->track].draft.spec.name;
    if constexpr (requires { structure.s_m; }) structure.s_m = RoundedTo(place->at.s_m, 100.0);
    world.placed.push_back({number, structure});
    world.structures.push_back(std::move(structure));
  };
  const auto leave_out = [&](const char* what, const char* reason) {
    world.left_out.push_back({what, place->at.s_m, place->at.s_m, reason, number});
  };
  if (railway == "buffer_stop") {
    BufferStopSpec stop;
    const std::optional<TrackTip> tip = TipAt(*place, world);
    if (!tip) return leave_out("buffer_stop", "its track goes on behind it");
    stop.at = *tip;
    return add(stop);
  }
  if (std::abs(place->at.beyond_m) > kStandsOn_m) return;
  if (railway == "level_crossing" || railway == "crossing") {
    const LevelCrossingSpec* road = RoadAt(*place, world);
    if (road == nullptr) return add(LevelCrossingOf(thing));
    world.placed.push_back({number, *road});
  } else if (railway == "milestone") {
    BoardSpec board;
    board.kind = BoardKind::kKilometre;
    add(board);
  } else if (railway == "derail") {
    add(DerailerSpec{});
  } else if (railway == "signal") {
    const std::optional<SignalSpec> signal = SignalOf(thing.tags, place->is_forward);
    if (signal) return add(*signal);
    leave_out("signal", "the map does not say which kind it is");
  }
}

}  // namespace railcast
