#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structures.h"
#include "core/rail/track/cross_section.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr double kDeckTop_m = -CrossSection::kFormationDepth_m;
constexpr double kEdgeBeamWidth_m = 0.4;
constexpr double kEdgeBeamTop_m = -0.35;

/// Abutments reach this far into the gap, and beside the deck.
constexpr double kAbutmentDepth_m = 1.2;
constexpr double kAbutmentBeside_m = 0.5;
constexpr double kFoundation_m = 0.5;  ///< Below the bottom of the gap.

/// Slope of the gap's banks and of the cones: rise over run.
constexpr double kBankSlope = 1.0 / 1.5;

constexpr double kRailingPostSpacing_m = 2.0;
constexpr double kRailingPostWidth_m = 0.06;
constexpr double kRailingBar_m = 0.04;
constexpr int kNumRailingBars = 3;

/// What carries the line, with y from the axis of its track.
struct DeckEdges {
  double right_m{};
  double left_m{};
};

DeckEdges EdgesOf(const WorldTracks& tracks, const BridgeSpec& bridge) {
  const TrackSpread spread = SpreadOf(tracks, bridge, kSharedBridge_m);
  return {.right_m = spread.right_m - bridge.edge_distance_m,
          .left_m = spread.left_m + bridge.edge_distance_m};
}

Outline DeckOutline(const BridgeSpec& bridge, const DeckEdges& edges) {
  const double bottom_m = kDeckTop_m - bridge.deck_thickness_m;
  const double right_m = edges.right_m + kEdgeBeamWidth_m;
  const double left_m = edges.left_m - kEdgeBeamWidth_m;
  return {{edges.right_m, bottom_m}, {edges.left_m, bottom_m},       {edges.left_m, kEdgeBeamTop_m},
          {left_m, kEdgeBeamTop_m},  {left_m, kDeckTop_m},           {right_m, kDeckTop_m},
          {right_m, kEdgeBeamTop_m}, {edges.right_m, kEdgeBeamTop_m}};
}

class BridgeBuilder {
 public:
  BridgeBuilder(const ChunkContext& context, const BridgeSpec& bridge, Chunk& chunk)
      : context_(context),
        bridge_(bridge),
        track_(context, bridge.track),
        edges_(EdgesOf(TracksOf(context), bridge)),
        chunk_(chunk) {}

  void Add() {
    const double farthest_m =
        std::max(std::abs(edges_.right_m), std::abs(edges_.left_m)) + edges_.left_m;
    const auto stretch = StretchInChunk(track_, RangeOf(bridge_), farthest_m,
                                        [&](double s_m) { return track_.Upright(s_m); });
    if (stretch) {
      AppendSweptSolid(*stretch, DeckOutline(bridge_, edges_), Concrete());
      if (bridge_.railing_height_m > 0.0) AddRailings(*stretch);
    }
    if (track_.Holds(bridge_.begin_s_m)) AddAbutment(bridge_.begin_s_m, 0.0, kAbutmentDepth_m);
    if (track_.Holds(bridge_.end_s_m)) AddAbutment(bridge_.end_s_m, -kAbutmentDepth_m, 0.0);
  }

 private:
  [[nodiscard]] Mesh& Concrete() {
    return MeshOf(context_.surfaces.structures.bridge, chunk_.ground);
  }

  void AddAbutment(double s_m, double begin_x_m, double end_x_m) {
    Concrete().Append(MakeBox({Vector3(begin_x_m, edges_.right_m - kAbutmentBeside_m,
                                       -(bridge_.depth_m + kFoundation_m)),
                               Vector3(end_x_m, edges_.left_m + kAbutmentBeside_m,
                                       kDeckTop_m - 0.5 * bridge_.deck_thickness_m)}),
                      track_.Upright(s_m));
  }

  void AddRailings(const Stretch& stretch) {
    Mesh& steel = MeshOf(context_.surfaces.structures.bridge_railing, chunk_.ground);
    const double top_m = kEdgeBeamTop_m + bridge_.railing_height_m;
    const double half_m = 0.5 * kRailingPostWidth_m;
    const Mesh post =
        MakeBox({Vector3(-half_m, -half_m, kEdgeBeamTop_m), Vector3(half_m, half_m, top_m)});
    for (const double y_m :
         {edges_.right_m + 0.5 * kEdgeBeamWidth_m, edges_.left_m - 0.5 * kEdgeBeamWidth_m}) {
      for (int bar = 1; bar <= kNumRailingBars; ++bar) {
        const double z_m =
            std::lerp(kEdgeBeamTop_m, top_m, 1.0 * bar / kNumRailingBars) - kRailingBar_m;
        const double bar_m = 0.5 * kRailingBar_m;
        AppendSweptSolid(
            stretch, RectangleOutline(y_m - bar_m, z_m, y_m + bar_m, z_m + kRailingBar_m), steel);
      }
      for (const double s_m : track_.Places(RangeOf(bridge_), kRailingPostSpacing_m)) {
        steel.Append(post, track_.Upright(s_m) * Eigen::Translation3d(0.0, y_m, 0.0));
      }
    }
  }

  const ChunkContext& context_;
  const BridgeSpec& bridge_;
  StructureTrack track_;
  DeckEdges edges_;
  Chunk& chunk_;
};

/// How much lower the ground is about one bridge; d from the axis of its track.
double DropAbout_m(const BridgeSpec& bridge, const DeckEdges& edges, double s_m, double d_m) {
  const double deepest_m = bridge.depth_m - CrossSection::kFormationDepth_m;
  // Positive outside the gap. Its ends are inside the abutments, which hide the step below the
  // deck.
  const double beyond_m = std::max(bridge.begin_s_m + 0.5 * kAbutmentDepth_m - s_m,
                                   s_m - (bridge.end_s_m - 0.5 * kAbutmentDepth_m));
  const double beside_m =
      std::max(edges.right_m - kAbutmentBeside_m - d_m, d_m - (edges.left_m + kAbutmentBeside_m));
  if (beside_m <= 0.0) return beyond_m < 0.0 ? deepest_m : 0.0;
  const double from_bank_m = beyond_m > 0.0 ? beside_m : std::hypot(beside_m, beyond_m);
  const double at_bank_m = deepest_m - kBankSlope * std::max(0.0, beyond_m);
  return std::clamp(std::min(at_bank_m, kBankSlope * from_bank_m), 0.0, deepest_m);
}

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

void AddStructure(const ChunkContext& context, const BridgeSpec& bridge, Chunk& chunk) {
  BridgeBuilder(context, bridge, chunk).Add();
}

std::vector<ClearedArea> ClearedBy(const WorldTracks& tracks, const BridgeSpec& bridge) {
  const DeckEdges edges = EdgesOf(tracks, bridge);
  std::vector<ClearedArea> areas = ClearedAround({.begin_s_m = bridge.begin_s_m,
                                                  .end_s_m = bridge.end_s_m,
                                                  .right_m = edges.right_m - kAbutmentBeside_m,
                                                  .left_m = edges.left_m + kAbutmentBeside_m,
                                                  .cleared = {}});
  // Masts stand on the deck.
  std::erase_if(areas, [](const ClearedArea& area) {
    return area.cleared == std::vector<Clearing>{Clearing::kMast};
  });
  return areas;
}

BridgeGaps::BridgeGaps(const WorldTracks& tracks, double begin_s_m, double end_s_m) {
  for (const StructureSpec& structure : tracks.world.structures) {
    const auto* bridge = std::get_if<BridgeSpec>(&structure);
    if (bridge == nullptr) continue;
    const double reach_m = bridge->depth_m / kBankSlope;
    if (end_s_m < bridge->begin_s_m - reach_m || begin_s_m > bridge->end_s_m + reach_m) continue;
    const TrackCourse* track = tracks.CourseOf(bridge->track);
    if (track == nullptr) continue;
    const DeckEdges edges = EdgesOf(tracks, *bridge);
    gaps_.push_back({bridge, track, edges.right_m, edges.left_m});
  }
}

double BridgeGaps::Drop_m(double s_m, double d_m) const {
  double drop_m = 0.0;
  for (const Gap& gap : gaps_) {
    const double reach_m = gap.bridge->depth_m / kBankSlope;
    if (s_m < gap.bridge->begin_s_m - reach_m || s_m > gap.bridge->end_s_m + reach_m) continue;
    drop_m = std::max(drop_m, DropAbout_m(*gap.bridge, {gap.right_m, gap.left_m}, s_m,
                                          d_m - gap.track->OffsetAt(s_m).d_m));
  }
  return drop_m;
}

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
