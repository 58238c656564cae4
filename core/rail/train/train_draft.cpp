#include "core/rail/train/train_draft.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/text.h"
#include "core/rail/line/route.h"
#include "core/rail/line/track_length.h"
#include "core/rail/line/turnout_place.h"
#include "core/rail/train/bogies.h"
#include "core/rail/train/train_places.h"

namespace railcast {
namespace {

std::string WayText(const Route& route) {
  std::string names;
  for (const std::string& name : route.names) names += (names.empty() ? "" : ", ") + Quoted(name);
  return (route.names.size() == 1 ? "track " : "route ") + names;
}

/// The foremost buffers, as an object that the rest of the train follows.
ObjectSpec FrontOf(const TrainSpec& train) {
  ObjectSpec front;
  front.name = train.name;
  front.type = ObjectType::kBox;
  front.track = train.track;
  front.s_m = train.s_m;
  front.motion = train.motion;
  front.route = train.route;
  return front;
}

/// Whether the whole train is on its track at time 0.
bool CheckFits(const TrainSpec& train,
               const std::string& pointer,
               const Route& route,
               const TrackLength& track,
               WorldFaults& faults) {
  if (!faults.AreKnown({pointer + "/s_m"})) return false;
  // A train may end exactly where its track does, whatever the rounding.
  constexpr double kRounding_m = 1e-3;
  const double length_m = LengthOf_m(train.vehicles);
  const double before_m = track.UpTo(train.s_m);
  const double room_m = RunsBack(train) ? track.total_m() - before_m : before_m;
  if (length_m > track.total_m() + kRounding_m) {
    faults.Add(pointer + "/vehicles",
               "must be at most as long together as " + WayText(route) + ", " +
                   MetresText(track.total_m()) + " m",
               MetresText(length_m) + " m");
    return false;
  }
  if (length_m <= room_m + kRounding_m) return true;
  faults.Add(pointer + "/s_m",
             "must leave room for the train's " + MetresText(length_m) + " m on " + WayText(route) +
                 ", " + StretchText(route.course.begin_s_m(), route.course.end_s_m()),
             NumberText(train.s_m));
  return false;
}

// Those ahead of the foremost buffers are checked with its path.
void CheckTurnoutsBelow(const TrainSpec& train,
                        const std::string& pointer,
                        const TracksOfWorld& tracks,
                        const Route& route,
                        double rear_s_m,
                        WorldFaults& faults) {
  const auto [least_m, most_m] = std::minmax(rear_s_m, train.s_m);
  Route below = route;
  std::erase_if(below.passages, [&](const RoutePassage& passage) {
    const double s_m = tracks.network.turnouts[passage.turnout].s_m;
    return !(s_m > least_m && s_m < most_m);
  });
  const RouteSpec spec{.pointer = pointer + (train.route.empty() ? "/track" : "/route"),
                       .tracks = {},
                       .runs_back = RunsBack(train)};
  CheckPositions(tracks.world, tracks.network, below, spec, rear_s_m, faults);
}

}  // namespace

void DraftTrain(const TrainSpec& train,
                const std::string& pointer,
                const TrainTables& tables,
                WorldFaults& faults,
                WorldDraft& draft) {
  const std::optional<TrackPath> front =
      DraftPath(tables.tracks, FrontOf(train), pointer, 0, faults);
  if (!front || !faults.AreKnown({pointer + "/vehicles"})) return;
  const auto length = std::make_shared<const TrackLength>(tables.alignment, front->course());
  if (!CheckFits(train, pointer, front->route(), *length, faults)) return;
  const bool runs_back = RunsBack(train);
  const double train_m = LengthOf_m(train.vehicles);
  CheckTurnoutsBelow(train, pointer, tables.tracks, front->route(),
                     length->MovedFrom(train.s_m, runs_back ? train_m : -train_m), faults);
  for (std::size_t i = 0; i < train.vehicles.size(); ++i) {
    ObjectSpec spec;
    spec.name = NameOfVehicle(train, i);
    spec.type = train.vehicles[i].type;
    auto object =
        DraftObject(spec, pointer + "/vehicles/" + std::to_string(i), tables.objects, faults);
    if (!object) continue;
    TrackPath path = front->Behind(length, MiddleBehindFront_m(train.vehicles, i),
                                   PoseInTrain(train.vehicles[i], runs_back));
    object->moves = path.moves();
    GiveBogies(spec, path, tables.alignment, tables.objects.models, *object);
    draft.object_paths.push_back({std::move(path), {}});
    draft.objects.push_back(std::move(*object));
  }
}

}  // namespace railcast
