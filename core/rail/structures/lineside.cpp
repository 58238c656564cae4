#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/rail/line/rail_section.h"
#include "core/rail/structures/lineside_models.h"
#include "core/rail/structures/standing_height.h"
#include "core/rail/structures/structures.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

/// What a signal or board has unless its spec says otherwise.
struct FacingDefaults {
  double distance_m{};
  double height_m{};
  PlateSize plate{};
};

FacingDefaults DefaultsOf(SignalKind kind) {
  switch (kind) {
    case SignalKind::kMain:
      return {.distance_m = 3.1, .height_m = 5.5};
    case SignalKind::kDistant:
      return {.distance_m = 3.1, .height_m = 4.5};
    case SignalKind::kShunting:
      break;
  }
  return {.distance_m = 2.2, .height_m = 0.8};
}

FacingDefaults DefaultsOf(BoardKind kind) {
  switch (kind) {
    case BoardKind::kSpeed:
      return {.distance_m = 3.0, .height_m = 2.4, .plate = {0.70, 0.90}};
    case BoardKind::kSpeedAnnouncement:
      return {.distance_m = 3.0, .height_m = 2.4, .plate = {1.00, 0.85}};
    case BoardKind::kKilometre:
      return {.distance_m = 3.0, .height_m = 0.8, .plate = {0.40, 0.55}};
    case BoardKind::kFoulingPoint:
      break;
  }
  return {.distance_m = 2.0, .height_m = 0.1};
}

LinesidePlace FacingPlace(const FacingSpec& spec, double distance_m) {
  const bool is_rising = spec.direction == RunningDirection::kRising;
  const TrackSide side = spec.side.value_or(is_rising ? TrackSide::kRight : TrackSide::kLeft);
  return {.s_m = spec.s_m,
          .d_m = SignOf(side) * spec.distance_m.value_or(distance_m),
          .yaw_rad = is_rising ? 0.0 : std::numbers::pi};
}

/// The front of what stands beside a track looks towards it.
LinesidePlace FrontToTrack(double s_m, TrackSide side, double distance_m) {
  return {.s_m = s_m,
          .d_m = SignOf(side) * distance_m,
          .yaw_rad = side == TrackSide::kLeft ? 0.0 : std::numbers::pi};
}

Model ModelOf(const SignalSpec& signal, const LinesideSurfaces& surfaces) {
  const double height_m = signal.height_m.value_or(DefaultsOf(signal.kind).height_m);
  return MakeLinesideModel(std::string(NameOf(signal.kind)) + "_signal", surfaces,
                           {.height_m = height_m});
}

Model ModelOf(const BoardSpec& board, const LinesideSurfaces& surfaces) {
  const FacingDefaults defaults = DefaultsOf(board.kind);
  const double height_m = board.height_m.value_or(defaults.height_m);
  PlateSize plate = defaults.plate;
  if (board.size_m) plate = {(*board.size_m)[0], (*board.size_m)[1]};
  if (board.kind == BoardKind::kFoulingPoint) {
    return MakeLinesideModel("fouling_marker", surfaces, {.height_m = height_m});
  }
  if (board.kind == BoardKind::kSpeedAnnouncement) {
    return MakeTriangularBoard(plate, height_m, surfaces);
  }
  return MakeBoard(plate, height_m, surfaces);
}

Model ModelOf(const FurnitureSpec& furniture, const LinesideSurfaces& surfaces) {
  // The height of a lamp or a shelter; benches leave nothing open.
  const double height_m = furniture.kind == FurnitureKind::kLamp ? 6.0 : 2.5;
  return MakeLinesideModel(NameOf(furniture.kind), surfaces,
                           {.length_m = 4.0, .depth_m = 1.5, .height_m = height_m});
}

double SleeperAt_m(double s_m) {
  return kSleeperSpacing_m * std::round(s_m / kSleeperSpacing_m);
}

template <class Spec>
void AddFacing(const ChunkContext& context, const Spec& spec, Chunk& chunk) {
  const StructureTrack track(context, spec.track);
  if (!track.Holds(spec.s_m)) return;
  AppendModel(ModelOf(spec, context.surfaces.structures.lineside),
              AtTopOfRail(track, FacingPlace(spec, DefaultsOf(spec.kind).distance_m)),
              chunk.ground);
}

/// The areas that something round a place clears.
std::vector<ClearedArea> ClearedRound(double s_m, double d_m, const Eigen::Vector2d& half_m) {
  return ClearedAround({.begin_s_m = s_m - half_m.x(),
                        .end_s_m = s_m + half_m.x(),
                        .right_m = d_m - half_m.y(),
                        .left_m = d_m + half_m.y(),
                        .cleared = {}});
}

}  // namespace

void AddStructure(const ChunkContext& context, const SignalSpec& signal, Chunk& chunk) {
  AddFacing(context, signal, chunk);
}

void AddStructure(const ChunkContext& context, const BoardSpec& board, Chunk& chunk) {
  AddFacing(context, board, chunk);
}

void AddStructure(const ChunkContext& context, const BaliseSpec& balise, Chunk& chunk) {
  const StructureTrack track(context, balise.track);
  const double s_m = SleeperAt_m(balise.s_m);
  if (!track.Holds(s_m)) return;
  const SleeperSeat seat = SeatOf(track.spec().sleeper);
  AppendModel(MakeLinesideModel("balise", context.surfaces.structures.lineside),
              track.Canted(s_m) * Eigen::Translation3d(0.0, 0.0, seat.top_m - seat.middle_drop_m),
              chunk.ground);
}

void AddStructure(const ChunkContext& context, const DerailerSpec& derailer, Chunk& chunk) {
  const StructureTrack track(context, derailer.track);
  if (!track.Holds(derailer.s_m)) return;
  const double yaw_rad = derailer.side == TrackSide::kLeft ? 0.0 : std::numbers::pi;
  AppendModel(MakeLinesideModel("derailer", context.surfaces.structures.lineside,
                                {.shift_m = RailShift_m(context.spec.alignment)}),
              track.Canted(derailer.s_m) * Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()),
              chunk.ground);
}

void AddStructure(const ChunkContext& context, const RelayBoxSpec& box, Chunk& chunk) {
  const StructureTrack track(context, box.track);
  if (!track.Holds(box.s_m)) return;
  const auto& [length_m, depth_m, height_m] = box.size_m;
  const Model model =
      MakeLinesideModel("relay_box", context.surfaces.structures.lineside,
                        {.length_m = length_m, .depth_m = depth_m, .height_m = height_m});
  AppendModel(model,
              OnGround(context, track, FrontToTrack(box.s_m, box.side, box.distance_m), model),
              chunk.ground);
}

void AddStructure(const ChunkContext& context, const FurnitureSpec& furniture, Chunk& chunk) {
  const StructureTrack track(context, furniture.track);
  if (!track.Holds(furniture.s_m)) return;
  const Model model = ModelOf(furniture, context.surfaces.structures.lineside);
  const LinesidePlace place = FrontToTrack(furniture.s_m, furniture.side, furniture.distance_m);
  Transform pose = AtTopOfRail(track, place);
  if (furniture.h_m) {
    pose.translation().z() += *furniture.h_m;
  } else {
    pose = OnGround(context, track, place, model);
  }
  AppendModel(model, pose, chunk.ground);
}

void AddStructure(const ChunkContext& context, const BufferStopSpec& stop, Chunk& chunk) {
  const StructureTrack track(context, stop.track);
  const bool is_end = stop.at == TrackTip::kEnd;
  const double face_s_m = is_end ? track.course().end_s_m() - kBufferStopLength_m
                                 : track.course().begin_s_m() + kBufferStopLength_m;
  if (!track.Holds(face_s_m)) return;
  const double yaw_rad = is_end ? 0.0 : std::numbers::pi;
  AppendModel(MakeLinesideModel("buffer_stop", context.surfaces.structures.lineside,
                                {.shift_m = RailShift_m(context.spec.alignment)}),
              track.Canted(face_s_m) * Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()), chunk.ground);
}

std::vector<ClearedArea> ClearedBy(const SignalSpec& signal) {
  const LinesidePlace place = FacingPlace(signal, DefaultsOf(signal.kind).distance_m);
  return ClearedRound(place.s_m, place.d_m, {0.3, 0.4});
}

std::vector<ClearedArea> ClearedBy(const BoardSpec& board) {
  const LinesidePlace place = FacingPlace(board, DefaultsOf(board.kind).distance_m);
  return ClearedRound(place.s_m, place.d_m, {0.1, 0.1});
}

std::vector<ClearedArea> ClearedBy(const BaliseSpec& /*balise*/) {
  return {};
}

std::vector<ClearedArea> ClearedBy(const DerailerSpec& /*derailer*/) {
  return {};
}

std::vector<ClearedArea> ClearedBy(const RelayBoxSpec& box) {
  return ClearedRound(box.s_m, SignOf(box.side) * box.distance_m,
                      {0.5 * box.size_m[0], 0.5 * box.size_m[1]});
}

std::vector<ClearedArea> ClearedBy(const FurnitureSpec& furniture) {
  const bool is_shelter = furniture.kind == FurnitureKind::kShelter;
  return ClearedRound(furniture.s_m, SignOf(furniture.side) * furniture.distance_m,
                      is_shelter ? Eigen::Vector2d(2.0, 0.75) : Eigen::Vector2d(0.9, 0.3));
}

std::vector<ClearedArea> ClearedBy(const BufferStopSpec& /*stop*/) {
  return {};
}

}  // namespace railcast
