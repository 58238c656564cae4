#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/base/units.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/line/rail_section.h"
#include "core/rail/structures/crossing_road.h"
#include "core/rail/structures/lineside_models.h"
#include "core/rail/structures/standing_height.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structures.h"

namespace railcast {
namespace {

/// Panels reach from the flangeway of one rail to that of the other, and outwards from each rail.
/// The gauge face is 717.5 mm from the axis, the head's outer side 790 mm.
constexpr double kInnerPanel_m = 0.6575;  // A flangeway of 60 mm.
constexpr double kFlangewayEnd_m = 0.710;
constexpr double kFlangewayDepth_m = 0.080;
constexpr double kOuterPanel_m = 0.800;
constexpr double kPanelDepth_m = 0.180;

constexpr double kRoadColumn_m = 2.0;
/// How deep the shoulder's foot lies in the ground.
constexpr double kShoulderFoot_m = 0.15;

/// Distances of barriers and signs from the axis of the outermost track and from the road's edge.
constexpr double kBarrierDistance_m = 4.0;
constexpr double kSignDistance_m = 4.6;
constexpr double kBarrierBeside_m = 0.5;
constexpr double kSignBeside_m = 1.2;
constexpr double kUprightBarrier_deg = 85.0;

void AddPanels(const CrossingRoad& road,
               const CrossingRoad::Lane& lane,
               double shift_m,
               const SurfaceClass& surface,
               Chunk& chunk) {
  Stretch stretch{.frames = {}, .has_begin = true, .has_end = true};
  for (const double s_m : lane.track.Stations({road.begin_s_m(), road.end_s_m()}, 0.0)) {
    stretch.frames.push_back(lane.track.Canted(s_m));
  }
  Mesh& mesh = MeshOf(surface, chunk.ground);
  const auto sweep = [&](double right_m, double left_m, double top_m) {
    AppendSweptSolid(stretch, RectangleOutline(right_m, -kPanelDepth_m, left_m, top_m), mesh);
  };
  const double inner_m = kInnerPanel_m + shift_m;
  const double flangeway_m = kFlangewayEnd_m + shift_m;
  const double outer_m = kOuterPanel_m + shift_m;
  sweep(-inner_m, inner_m, 0.0);
  sweep(inner_m, flangeway_m, -kFlangewayDepth_m);
  sweep(-flangeway_m, -inner_m, -kFlangewayDepth_m);
  sweep(outer_m, lane.edge_m, 0.0);
  sweep(-lane.edge_m, -outer_m, 0.0);
}

/// A strip of asphalt between two lateral positions. Where it ends at a lane's panels, it meets
/// their edge exactly.
struct AsphaltStrip {
  double right_d_m{};
  double left_d_m{};
  const CrossingRoad::Lane* right_lane = nullptr;
  const CrossingRoad::Lane* left_lane = nullptr;
};

std::vector<AsphaltStrip> StripsOf(const CrossingRoad& road) {
  std::vector<AsphaltStrip> strips{{.right_d_m = road.right_d_m()}};
  for (const CrossingRoad::Lane& lane : road.lanes()) {
    strips.back().left_d_m = lane.d_m - lane.edge_m;
    strips.back().left_lane = &lane;
    strips.push_back({.right_d_m = lane.d_m + lane.edge_m, .right_lane = &lane});
  }
  strips.back().left_d_m = road.left_d_m();
  return strips;
}

/// Lays the asphalt of one strip with its shoulders.
class StripBuilder {
 public:
  StripBuilder(const ChunkContext& context, const CrossingRoad& road, const AsphaltStrip& strip)
      : context_(context), road_(road), strip_(strip) {
    const double width_m = strip.left_d_m - strip.right_d_m;
    num_steps_ = std::max(1, static_cast<int>(std::ceil(width_m / kRoadColumn_m)));
  }

  void Add(Chunk& chunk) const {
    const LinesideSurfaces& surfaces = context_.surfaces.structures.lineside;
    const StructureTrack& track = road_.lanes().front().track;
    // The outermost part of the road has the longest chords in a curve.
    const double outermost_m = std::max(std::abs(strip_.left_d_m), std::abs(strip_.right_d_m));
    std::vector<Vector3> points_m;
    for (const double s_m : track.Stations({road_.begin_s_m(), road_.end_s_m()}, outermost_m)) {
      AppendRow(s_m, points_m);
    }
    MeshOf(surfaces.asphalt, chunk.ground).Append(GridOf(points_m));
    AddShoulder(road_.begin_s_m(), -1.0, chunk);
    AddShoulder(road_.end_s_m(), 1.0, chunk);
  }

 private:
  [[nodiscard]] double PlaceOf_m(int column) const {
    return std::lerp(strip_.right_d_m, strip_.left_d_m, 1.0 * column / num_steps_);
  }
  [[nodiscard]] bool EndsRight() const { return strip_.right_lane == nullptr; }
  [[nodiscard]] bool EndsLeft() const { return strip_.left_lane == nullptr; }

  [[nodiscard]] Vector3 RoadPoint(double s_m, int column) const {
    if (column == 0 && !EndsRight()) return road_.PanelEdge(*strip_.right_lane, 1.0, s_m);
    if (column == num_steps_ && !EndsLeft()) return road_.PanelEdge(*strip_.left_lane, -1.0, s_m);
    return road_.PointAt(s_m, PlaceOf_m(column));
  }
  /// The foot of a shoulder: in the ground, and never above the road.
  [[nodiscard]] Vector3 FootPoint(double s_m, double d_m, double road_m) const {
    Vector3 foot_m = GroundPoint(context_, s_m, d_m);
    foot_m.z() = std::min(foot_m.z(), road_m) - kShoulderFoot_m;
    return foot_m;
  }

  /// Where the road ends, it has a shoulder, too.
  void AppendRow(double s_m, std::vector<Vector3>& points_m) const {
    constexpr double kWidth_m = CrossingRoad::kShoulderWidth_m;
    if (EndsRight()) {
      const double road_m = RoadPoint(s_m, 0).z();
      points_m.push_back(FootPoint(s_m, strip_.right_d_m - kWidth_m, road_m));
    }
    for (int column = 0; column <= num_steps_; ++column) {
      points_m.push_back(RoadPoint(s_m, column));
    }
    if (EndsLeft()) {
      const double road_m = RoadPoint(s_m, num_steps_).z();
      points_m.push_back(FootPoint(s_m, strip_.left_d_m + kWidth_m, road_m));
    }
  }

  void AddShoulder(double edge_s_m, double ahead, Chunk& chunk) const {
    const double foot_s_m = edge_s_m + ahead * CrossingRoad::kShoulderWidth_m;
    std::vector<Vector3> edge_m;
    AppendRow(edge_s_m, edge_m);
    std::vector<Vector3> foot_m;
    const int first = EndsRight() ? 1 : 0;
    for (std::size_t i = 0; i < edge_m.size(); ++i) {
      const int column = std::clamp(static_cast<int>(i) - first, 0, num_steps_);
      foot_m.push_back(FootPoint(foot_s_m, PlaceOf_m(column), edge_m[i].z()));
    }
    std::vector<Vector3>& rows_m = ahead < 0.0 ? foot_m : edge_m;
    const std::vector<Vector3>& after_m = ahead < 0.0 ? edge_m : foot_m;
    rows_m.insert(rows_m.end(), after_m.begin(), after_m.end());
    MeshOf(context_.surfaces.ground, chunk.ground).Append(GridOf(rows_m));
  }

  [[nodiscard]] Mesh GridOf(const std::vector<Vector3>& points_m) const {
    const int num_columns = num_steps_ + 1 + (EndsRight() ? 1 : 0) + (EndsLeft() ? 1 : 0);
    return MeshOfGrid(points_m, static_cast<std::size_t>(num_columns),
                      [](std::size_t, std::size_t) { return true; });
  }

  const ChunkContext& context_;
  const CrossingRoad& road_;
  const AsphaltStrip& strip_;
  int num_steps_;
};

double BarrierAngle_rad(const LevelCrossingSpec& crossing) {
  const double state_deg = crossing.barriers == BarrierState::kOpen ? kUprightBarrier_deg : 0.0;
  return RadFromDeg(crossing.barrier_angle_deg.value_or(state_deg));
}

/// Where what drivers meet stands: on the right of the road, on their side of the tracks.
class WarningPlaces {
 public:
  /// @param side Where they come from: +1 from the left of the track.
  WarningPlaces(const CrossingRoad& road, const LevelCrossingSpec& crossing, double side)
      : road_(road),
        crossing_(crossing),
        lane_(side > 0.0 ? road.lanes().back() : road.lanes().front()),
        side_(side) {}

  [[nodiscard]] double boom_length_m() const {
    return 0.5 * crossing_.road_width_m + kBarrierBeside_m;
  }
  [[nodiscard]] Transform Barrier() const {
    return At(kBarrierBeside_m, kBarrierDistance_m, side_ > 0.0 ? 0.0 : std::numbers::pi);
  }
  [[nodiscard]] Transform Sign() const {
    return At(kSignBeside_m, kSignDistance_m, -side_ * 0.5 * std::numbers::pi);
  }

 private:
  [[nodiscard]] Transform At(double beside_m, double distance_m, double yaw_rad) const {
    const double s_m = crossing_.s_m - side_ * (0.5 * crossing_.road_width_m + beside_m);
    Transform pose = lane_.track.Upright(s_m);
    const double on_s_m = std::clamp(s_m, road_.begin_s_m(), road_.end_s_m());
    const double d_m =
        std::clamp(lane_.d_m + side_ * distance_m, road_.right_d_m(), road_.left_d_m());
    pose.translation() = pose * Vector3(0.0, d_m - lane_.d_m, 0.0);
    pose.translation().z() = road_.PointAt(on_s_m, d_m).z();
    return Transform(pose * Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()));
  }

  const CrossingRoad& road_;
  const LevelCrossingSpec& crossing_;
  const CrossingRoad::Lane& lane_;
  double side_;
};

/// Adds barrier and sign on one side; the booms of moving barriers are objects.
void AddWarnings(const WarningPlaces& places,
                 const LevelCrossingSpec& crossing,
                 const LinesideSurfaces& surfaces,
                 Chunk& chunk) {
  if (!crossing.barrier_angles_deg.empty()) {
    AppendModel(MakeLinesideModel("boom_pedestal", surfaces), places.Barrier(), chunk.ground);
  } else if (crossing.barriers != BarrierState::kNone) {
    AppendModel(MakeHalfBarrier(places.boom_length_m(), BarrierAngle_rad(crossing), surfaces),
                places.Barrier(), chunk.ground);
  }
  if (crossing.has_signs) {
    AppendModel(MakeLinesideModel("crossing_sign", surfaces), places.Sign(), chunk.ground);
  }
}

}  // namespace

void AddStructure(const ChunkContext& context, const LevelCrossingSpec& crossing, Chunk& chunk) {
  if (!StructureTrack(context, crossing.track).Holds(crossing.s_m)) return;
  const CrossingRoad road(context, crossing);
  const LinesideSurfaces& surfaces = context.surfaces.structures.lineside;
  for (const CrossingRoad::Lane& lane : road.lanes()) {
    AddPanels(road, lane, RailShift_m(context.spec.alignment), surfaces.slab, chunk);
  }
  for (const AsphaltStrip& strip : StripsOf(road)) {
    if (strip.right_d_m < strip.left_d_m) StripBuilder(context, road, strip).Add(chunk);
  }
  for (const double side : {-1.0, 1.0}) {
    AddWarnings(WarningPlaces(road, crossing, side), crossing, surfaces, chunk);
  }
}

std::vector<MovingBoom> MovingBoomsOf(const ChunkContext& context,
                                      const LevelCrossingSpec& crossing) {
  std::vector<MovingBoom> booms;
  if (crossing.barrier_angles_deg.empty()) return booms;
  const CrossingRoad road(context, crossing);
  const LinesideSurfaces& surfaces = context.surfaces.structures.lineside;
  for (const double side : {-1.0, 1.0}) {
    const WarningPlaces places(road, crossing, side);
    booms.push_back(
        {.name = BoomName(crossing.name, side),
         .model = std::make_shared<const Model>(MakeBoom(places.boom_length_m(), surfaces)),
         .world_from_barrier = context.chunk_from_world.inverse() * places.Barrier(),
         .angles_deg = crossing.barrier_angles_deg});
  }
  return booms;
}

std::vector<ClearedArea> ClearedBy(const LevelCrossingSpec& crossing) {
  const double half_m = 0.5 * crossing.road_width_m + CrossingRoad::kShoulderWidth_m;
  return ClearedAround({.begin_s_m = crossing.s_m - half_m,
                        .end_s_m = crossing.s_m + half_m,
                        .right_m = -crossing.road_length_m,
                        .left_m = crossing.road_length_m,
                        .cleared = {}});
}

double MovingBoom::Angle_rad(std::int64_t time_ns) const {
  Check(!angles_deg.empty(), "a moving boom has angles");
  const double time_s = 1e-9 * static_cast<double>(time_ns);
  const auto after = std::ranges::upper_bound(angles_deg, time_s, {}, &TimedValue::time_s);
  if (after == angles_deg.begin()) return RadFromDeg(after->value);
  const auto before = after - 1;
  if (after == angles_deg.end()) return RadFromDeg(before->value);
  const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
  return RadFromDeg(std::lerp(before->value, after->value, share));
}

Transform MovingBoom::WorldFromBoom(std::int64_t time_ns) const {
  return world_from_barrier * BarrierFromBoom(Angle_rad(time_ns));
}

std::string BoomName(const std::string& crossing, double side) {
  return crossing + (side > 0.0 ? "/left" : "/right");
}

}  // namespace railcast
