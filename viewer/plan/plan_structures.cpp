#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/network/network.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/structures.h"
#include "viewer/plan/plan.h"

namespace railcast {
namespace {

struct StructureStyle {
  std::string_view title;
  Rgb rgb{};
  Plan::Sample sample{};
};

// In the order of StructureSpec.
constexpr auto kStructureStyles = std::to_array<StructureStyle>({
    {"platform", {200, 200, 190}, Plan::Sample::kLine},
    {"noise wall", {185, 130, 75}, Plan::Sample::kLine},
    {"fence", {150, 150, 90}, Plan::Sample::kLine},
    {"retaining wall", {175, 105, 105}, Plan::Sample::kLine},
    {"cable trough", {100, 160, 160}, Plan::Sample::kLine},
    {"tunnel", {150, 115, 200}, Plan::Sample::kLine},
    {"bridge", {100, 140, 215}, Plan::Sample::kLine},
    {"overbridge", {215, 150, 105}, Plan::Sample::kLine},
    {"third rail", {225, 70, 165}, Plan::Sample::kLine},
    {"slab track", {140, 140, 140}, Plan::Sample::kLine},
    {"signal", {255, 150, 120}, Plan::Sample::kSquare},
    {"board", {255, 255, 170}, Plan::Sample::kSquare},
    {"balise", {120, 255, 120}, Plan::Sample::kSquare},
    {"derailer", {255, 125, 10}, Plan::Sample::kSquare},
    {"relay box", {150, 205, 150}, Plan::Sample::kSquare},
    {"furniture", {150, 170, 215}, Plan::Sample::kSquare},
    {"buffer stop", {255, 100, 185}, Plan::Sample::kSquare},
    {"level crossing", {185, 185, 130}, Plan::Sample::kLine},
    {"building", {205, 120, 95}, Plan::Sample::kLine},
});
static_assert(kStructureStyles.size() == std::variant_size_v<StructureSpec>);

// Where the spec leaves a distance to the kind: marks are larger than the kinds differ.
constexpr double kUsualFacing_m = 3.0;
constexpr double kUsualThirdRail_m = 1.5;
constexpr double kRailFromAxis_m = 0.75;

/// Draws structures of all types in one style.
class StructureSketch {
 public:
  StructureSketch(const PlanScene& scene, const WorldTracks& tracks, Plan& plan)
      : scene_(scene), tracks_(tracks), plan_(plan) {}

  /// Returns whether anything of the structure lies in the stretch.
  bool Draw(const StructureSpec& structure) {
    rgb_ = kStructureStyles[structure.index()].rgb;
    is_any_ = false;
    std::visit([&](const auto& spec) { Sketch(spec); }, structure);
    return is_any_;
  }

 private:
  void Sketch(const PlatformSpec& platform) {
    const double side = SignOf(platform.side);
    AddBand(platform, side * platform.edge_distance_m,
            side * (platform.edge_distance_m + platform.width_m));
  }
  void Sketch(const NoiseWallSpec& wall) { AddAlong(wall, SignOf(wall.side) * wall.distance_m); }
  void Sketch(const FenceSpec& fence) { AddAlong(fence, SignOf(fence.side) * fence.distance_m); }
  void Sketch(const RetainingWallSpec& wall) {
    AddAlong(wall, SignOf(wall.side) * wall.distance_m);
  }
  void Sketch(const CableTroughSpec& trough) {
    AddAlong(trough, SignOf(trough.side) * (trough.distance_m + 0.5 * trough.width_m));
  }
  void Sketch(const ThirdRailSpec& rail) {
    AddAlong(rail, SignOf(rail.side) * rail.distance_m.value_or(kUsualThirdRail_m));
  }
  void Sketch(const SlabTrackSpec& slab) { AddBand(slab, -0.5 * slab.width_m, 0.5 * slab.width_m); }
  void Sketch(const TunnelSpec& tunnel) {
    const TunnelShape shape = TunnelShapeOf(tracks_, tunnel);
    const double middle_m = shape.spread.middle_m();
    AddBand(tunnel, middle_m - shape.radius_m, middle_m + shape.radius_m);
  }
  void Sketch(const BridgeSpec& bridge) {
    const TrackSpread spread = SpreadOf(tracks_, bridge, kSharedBridge_m);
    AddBand(bridge, spread.right_m - bridge.edge_distance_m,
            spread.left_m + bridge.edge_distance_m);
  }
  void Sketch(const OverbridgeSpec& bridge) {
    const double middle_s_m = 0.5 * (bridge.begin_s_m + bridge.end_s_m);
    const double half_m = 0.5 * (bridge.end_s_m - bridge.begin_s_m);
    // The road's way along the track for each metre across it.
    const double lean = 1.0 / std::tan(bridge.crossing_deg * std::numbers::pi / 180.0);
    AddStraight(bridge.track, middle_s_m,
                {{{lean * bridge.left_m - half_m, bridge.left_m},
                  {lean * bridge.left_m + half_m, bridge.left_m},
                  {-lean * bridge.right_m + half_m, -bridge.right_m},
                  {-lean * bridge.right_m - half_m, -bridge.right_m}}});
  }
  void Sketch(const LevelCrossingSpec& crossing) {
    const double half_m = 0.5 * crossing.road_width_m;
    const double reach_m = crossing.road_length_m;
    AddStraight(crossing.track, crossing.s_m,
                {{{-half_m, reach_m}, {half_m, reach_m}, {half_m, -reach_m}, {-half_m, -reach_m}}});
  }
  void Sketch(const BuildingSpec& building) {
    const TrackCourse* course = tracks_.CourseOf(building.track);
    if (course == nullptr || building.footprint_m.empty()) return;
    std::vector<Eigen::Vector2d> corners_m;
    bool is_inside = false;
    for (const auto& [s_m, d_m] : building.footprint_m) {
      corners_m.push_back(Place(*course, s_m, d_m));
      is_inside = is_inside || scene_.stretch.Holds(s_m);
    }
    if (is_inside) AddClosed(std::move(corners_m));
  }
  void Sketch(const FacingSpec& spec) {
    const TrackSide usual =
        spec.direction == RunningDirection::kRising ? TrackSide::kRight : TrackSide::kLeft;
    AddPoint(spec.track, spec.s_m,
             SignOf(spec.side.value_or(usual)) * spec.distance_m.value_or(kUsualFacing_m));
  }
  void Sketch(const BaliseSpec& balise) { AddPoint(balise.track, balise.s_m, 0.0); }
  void Sketch(const DerailerSpec& derailer) {
    AddPoint(derailer.track, derailer.s_m, SignOf(derailer.side) * kRailFromAxis_m);
  }
  void Sketch(const RelayBoxSpec& box) {
    AddPoint(box.track, box.s_m, SignOf(box.side) * box.distance_m);
  }
  void Sketch(const FurnitureSpec& furniture) {
    AddPoint(furniture.track, furniture.s_m, SignOf(furniture.side) * furniture.distance_m);
  }
  void Sketch(const BufferStopSpec& stop) {
    const TrackCourse* course = tracks_.CourseOf(stop.track);
    if (course == nullptr) return;
    AddPoint(stop.track, stop.at == TrackTip::kEnd ? course->end_s_m() : course->begin_s_m(), 0.0);
  }

  [[nodiscard]] Eigen::Vector2d Place(const TrackCourse& course, double s_m, double d_m) const {
    return scene_.frame.At(course.WorldFromTrack(scene_.world.alignment(), s_m, d_m).translation());
  }

  void AddPoint(const std::string& track, double s_m, double d_m) {
    const TrackCourse* course = tracks_.CourseOf(track);
    if (course == nullptr || !scene_.stretch.Holds(s_m)) return;
    plan_.marks.push_back({Place(*course, s_m, d_m), Eigen::Vector2d::Zero(), rgb_});
    is_any_ = true;
  }

  [[nodiscard]] std::vector<Eigen::Vector2d> Along(const StretchSpec& stretch, double d_m) const {
    const TrackCourse* course = tracks_.CourseOf(stretch.track);
    if (course == nullptr) return {};
    return PlanPoints(scene_, *course, {.from_s_m = stretch.begin_s_m, .to_s_m = stretch.end_s_m},
                      d_m);
  }

  void AddAlong(const StretchSpec& stretch, double d_m) {
    std::vector<Eigen::Vector2d> points_m = Along(stretch, d_m);
    if (!points_m.empty()) AddLine(std::move(points_m));
  }

  void AddBand(const StretchSpec& stretch, double one_d_m, double other_d_m) {
    std::vector<Eigen::Vector2d> points_m = Along(stretch, one_d_m);
    if (points_m.empty()) return;
    const std::vector<Eigen::Vector2d> back_m = Along(stretch, other_d_m);
    points_m.insert(points_m.end(), back_m.rbegin(), back_m.rend());
    AddClosed(std::move(points_m));
  }

  /// Adds a quadrangle of straight edges from corners ahead and left of a place of a track.
  void AddStraight(const std::string& track,
                   double s_m,
                   const std::array<std::array<double, 2>, 4>& corners) {
    const TrackCourse* course = tracks_.CourseOf(track);
    if (course == nullptr || !scene_.stretch.Holds(s_m)) return;
    const double heading_rad = course->Heading_rad(scene_.world.alignment(), s_m);
    const Eigen::Vector2d ahead =
        scene_.frame.Turned({std::cos(heading_rad), std::sin(heading_rad)});
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    const Eigen::Vector2d middle_m = Place(*course, s_m, 0.0);
    std::vector<Eigen::Vector2d> points_m;
    for (const auto& [ahead_m, left_m] : corners) {
      points_m.emplace_back(middle_m + ahead_m * ahead + left_m * left);
    }
    AddClosed(std::move(points_m));
  }

  void AddClosed(std::vector<Eigen::Vector2d> points_m) {
    points_m.push_back(points_m.front());
    AddLine(std::move(points_m));
  }

  void AddLine(std::vector<Eigen::Vector2d> points_m) {
    plan_.lines.push_back({.points_m = std::move(points_m), .rgb = rgb_});
    is_any_ = true;
  }

  const PlanScene& scene_;
  const WorldTracks& tracks_;
  Plan& plan_;
  Rgb rgb_{};
  bool is_any_{};
};

}  // namespace

void AddStructuresToPlan(const PlanScene& scene, Plan& plan) {
  // The tracks of yards have courses, too.
  WorldSpec world = scene.scenario.world;
  world.tracks = scene.world.tracks();
  const WorldTracks tracks{.world = world, .courses = scene.world.network().courses};
  StructureSketch sketch(scene, tracks, plan);
  std::array<bool, kStructureStyles.size()> are_there{};
  for (const StructureSpec& structure : world.structures) {
    if (sketch.Draw(structure)) are_there[structure.index()] = true;
  }
  for (std::size_t type = 0; type < kStructureStyles.size(); ++type) {
    const StructureStyle& style = kStructureStyles[type];
    if (are_there[type])
      plan.entries.push_back({std::string(style.title), style.rgb, style.sample});
  }
}

}  // namespace railcast
