#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structures.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr double kSharedOverbridge_m = 7.0;
constexpr double kPierDepth_m = 0.8;
constexpr double kOverbridgeFoot_m = -2.0;
constexpr double kEndWallDepth_m = 1.0;
constexpr double kParapetWidth_m = 0.25;
constexpr double kParapetHeight_m = 1.1;
constexpr double kRoadThickness_m = 0.1;

/// The bridge in its own frame: x across the road, y along it (to the left of the track), z up from
/// top of rail. Its middle is on the axis of its track.
class OverbridgeBuilder {
 public:
  OverbridgeBuilder(const ChunkContext& context, const OverbridgeSpec& bridge, Chunk& chunk)
      : context_(context), bridge_(bridge), track_(context, bridge.track), chunk_(chunk) {}

  void Add() {
    const double middle_s_m = 0.5 * (bridge_.begin_s_m + bridge_.end_s_m);
    if (!track_.Holds(middle_s_m)) return;
    const double skew_rad = RadFromDeg(bridge_.crossing_deg - 90.0);
    chunk_from_bridge_ = track_.Upright(middle_s_m) * Eigen::AngleAxisd(skew_rad, Vector3::UnitZ());
    // Along the track, the deck is as long as the stretch; across the road it is narrower.
    stretch_m_ = 1.0 / std::cos(skew_rad);
    half_m_ = 0.5 * (bridge_.end_s_m - bridge_.begin_s_m) / stretch_m_;
    AddDeck();
    AddWalls();
  }

 private:
  void AddBox(const SurfaceClass& surface, const Vector3& least, const Vector3& most) {
    MeshOf(surface, chunk_.ground).Append(MakeBox({least, most}), chunk_from_bridge_);
  }

  void AddDeck() {
    const StructureSurfaces& surfaces = context_.surfaces.structures;
    const double right_m = -bridge_.right_m * stretch_m_;
    const double left_m = bridge_.left_m * stretch_m_;
    const double top_m = bridge_.clearance_m + bridge_.deck_thickness_m;
    AddBox(surfaces.bridge, {-half_m_, right_m, bridge_.clearance_m}, {half_m_, left_m, top_m});
    for (const double side : {-1.0, 1.0}) {
      const double outside_m = side * half_m_;
      const double inside_m = side * (half_m_ - kParapetWidth_m);
      AddBox(surfaces.bridge, {std::min(outside_m, inside_m), right_m, top_m},
             {std::max(outside_m, inside_m), left_m, top_m + kParapetHeight_m});
    }
    const double road_m = half_m_ - kParapetWidth_m;
    AddBox(surfaces.road, {-road_m, right_m, top_m}, {road_m, left_m, top_m + kRoadThickness_m});
  }

  /// Piers beside the tracks, and walls that close the ends.
  void AddWalls() {
    const SurfaceClass& concrete = context_.surfaces.structures.bridge;
    const TrackSpread spread = SpreadOf(TracksOf(context_), bridge_, kSharedOverbridge_m);
    const auto add = [&](double near_m, double far_m) {
      if (std::abs(far_m) > std::abs(far_m > 0.0 ? bridge_.left_m : bridge_.right_m)) return;
      AddBox(concrete, {-half_m_, stretch_m_ * std::min(near_m, far_m), kOverbridgeFoot_m},
             {half_m_, stretch_m_ * std::max(near_m, far_m), bridge_.clearance_m});
    };
    const double left_m = spread.left_m + bridge_.pier_distance_m;
    const double right_m = spread.right_m - bridge_.pier_distance_m;
    add(left_m, left_m + kPierDepth_m);
    add(right_m, right_m - kPierDepth_m);
    add(bridge_.left_m - kEndWallDepth_m, bridge_.left_m);
    add(-bridge_.right_m + kEndWallDepth_m, -bridge_.right_m);
  }

  const ChunkContext& context_;
  const OverbridgeSpec& bridge_;
  StructureTrack track_;
  Chunk& chunk_;
  Transform chunk_from_bridge_ = Transform::Identity();
  double stretch_m_ = 1.0;
  double half_m_{};
};

}  // namespace

void AddStructure(const ChunkContext& context, const OverbridgeSpec& bridge, Chunk& chunk) {
  OverbridgeBuilder(context, bridge, chunk).Add();
}

std::vector<ClearedArea> ClearedBy(const WorldTracks&, const OverbridgeSpec& bridge) {
  // Obliquely, the ends of the deck lie ahead of its middle or behind.
  const double tangent = std::abs(std::tan(RadFromDeg(bridge.crossing_deg - 90.0)));
  const double ahead_m = tangent * std::max(bridge.left_m, bridge.right_m);
  const ClearedArea outline{.begin_s_m = bridge.begin_s_m - ahead_m,
                            .end_s_m = bridge.end_s_m + ahead_m,
                            .right_m = -bridge.right_m,
                            .left_m = bridge.left_m,
                            .cleared = {}};
  std::vector<ClearedArea> areas = ClearedAround(outline);
  for (ClearedArea& area : areas) {
    if (area.cleared.front() == Clearing::kMast) area.cleared.front() = Clearing::kSupport;
  }
  return areas;
}

void CheckShape(const StructurePlace& place, const OverbridgeSpec& bridge, WorldFaults& faults) {
  constexpr double kLeastRoad_m = 1.0;
  const double across = std::cos(RadFromDeg(bridge.crossing_deg - 90.0));
  const double least_m = (2.0 * kParapetWidth_m + kLeastRoad_m) / across;
  const double length_m = bridge.end_s_m - bridge.begin_s_m;
  if (!faults.AreKnown({place.pointer}) || !(length_m > 0.0) || length_m >= least_m) return;
  faults.Add(place.pointer + "/end_s_m",
             "must leave " + NumberText(kLeastRoad_m) + " m of road between the parapets, " +
                 ShortText(least_m) + " m from begin_s_m",
             NumberText(bridge.end_s_m));
}

}  // namespace railcast
