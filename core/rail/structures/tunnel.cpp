#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rail/catenary/system_height.h"
#include "core/rail/model_parts.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structure_types.h"
#include "core/rail/structures/swept_solid.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

/// The vault is a circle about this height above top of rail, down to its foot.
constexpr double kVaultCentre_m = 1.8;
constexpr double kVaultFoot_m = -0.9;
constexpr double kLiningThickness_m = 0.5;
constexpr double kVaultTolerance_m = 2e-3;  ///< Of the lining's faces in its cross-section.

/// Half the width beside the outermost axis at the vault's widest: a train (1.6 m), a gap (0.5 m)
/// and a way of escape 1.2 m wide.
constexpr double kRoomBesideAxis_m = 3.3;
/// Between the messenger wire and the lining.
constexpr double kWireClearance_m = 0.3;
/// Without a contact line: above the wagons' 4.28 m.
constexpr double kRoomAbove_m = 4.8;
/// Tracks this close share a tunnel.
constexpr double kSharedTunnel_m = 5.5;

constexpr double kTunnelFloor_m = -0.72;
constexpr double kWalkwayTop_m = 0.0;
/// Beside the outermost axis: behind the ballast's shoulder at 1.75 m.
constexpr double kWalkwayBegin_m = 2.0;
constexpr double kHandrailHeight_m = 1.0;  ///< Of the handrail above the walkway.
constexpr double kRailRadius_m = 0.02;
constexpr double kRailFromWall_m = 0.08;
constexpr int kRailSides = 8;

constexpr double kNicheHeight_m = 2.2;
constexpr double kNicheLength_m = 2.0;
constexpr double kNicheDepth_m = 0.8;  ///< From the wall at the niche's foot.

constexpr double kPortalDepth_m = 1.0;
constexpr double kPortalBeside_m = 2.5;
constexpr double kPortalAbove_m = 1.5;
constexpr double kPortalFoot_m = -1.5;
/// The portal's opening, wider than the lining, so that the lining's surface is the one seen.
constexpr double kPortalGap_m = 0.005;

/// A tunnel's cross-section: y from its middle, z above top of rail.
struct TunnelShape {
  TrackSpread spread;
  double radius_m{};

  [[nodiscard]] double WallAt_m(double height_m) const {
    const double above_m = height_m - kVaultCentre_m;
    return std::sqrt(std::max(0.0, radius_m * radius_m - above_m * above_m));
  }
  [[nodiscard]] double TopAngle_rad(double height_m) const {
    return std::asin(std::clamp((height_m - kVaultCentre_m) / radius_m, -1.0, 1.0));
  }
};

TunnelShape ShapeOf(const WorldTracks& tracks, const TunnelSpec& tunnel) {
  const WorldSpec& world = tracks.world;
  TunnelShape shape{.spread = SpreadOf(tracks, tunnel, kSharedTunnel_m), .radius_m = 0.0};
  const bool has_wire =
      world.catenary.enabled &&
      std::ranges::any_of(world.tracks, [](const TrackSpec& track) { return track.electrified; });
  const double above_m = has_wire ? world.catenary.contact_height_m +
                                        SystemHeightAt_m(world, tunnel.begin_s_m) + kWireClearance_m
                                  : kRoomAbove_m;
  const double half_m = shape.spread.half_width_m();
  shape.radius_m = tunnel.radius_m.value_or(
      std::max(half_m + kRoomBesideAxis_m, std::hypot(half_m, above_m - kVaultCentre_m)));
  return shape;
}

/// The arc about the vault's centre between two angles, from the right (0) over the top.
Outline ArcOutline(double radius_m, double begin_rad, double end_rad) {
  const double step_rad = 2.0 * std::acos(1.0 - kVaultTolerance_m / radius_m);
  const auto num_steps = std::max(1, static_cast<int>(std::ceil((end_rad - begin_rad) / step_rad)));
  Outline arc;
  for (int i = 0; i <= num_steps; ++i) {
    const double angle_rad = std::lerp(begin_rad, end_rad, 1.0 * i / num_steps);
    arc.emplace_back(-radius_m * std::cos(angle_rad),
                     kVaultCentre_m + radius_m * std::sin(angle_rad));
  }
  return arc;
}

/// Builds the part of a tunnel in a chunk. Outlines run from right (-y) to left, over the top.
class TunnelBuilder {
 public:
  TunnelBuilder(const ChunkContext& context, const TunnelSpec& tunnel, Chunk& chunk)
      : context_(context),
        tunnel_(tunnel),
        track_(context, tunnel.track),
        shape_(ShapeOf(TracksOf(context), tunnel)),
        chunk_(chunk) {}

  void Add() {
    const auto whole = StretchOf(WholeRange());
    if (whole) {
      AddShell(*whole);
      AddWalkways(*whole);
    }
    AddWalls();
    if (tunnel_.has_portals) AddPortals();
    if (tunnel_.has_handrail && whole) AddHandrails(*whole);
  }

 private:
  [[nodiscard]] ChainageRange WholeRange() const {
    return {.begin_s_m = tunnel_.begin_s_m, .end_s_m = tunnel_.end_s_m};
  }
  [[nodiscard]] Transform FrameAt(double s_m) const {
    return track_.Upright(s_m) * Eigen::Translation3d(0.0, shape_.spread.middle_m(), 0.0);
  }
  [[nodiscard]] std::optional<Stretch> StretchOf(const ChainageRange& range) const {
    return StretchInChunk(track_, range, shape_.spread.middle_m() + shape_.radius_m,
                          [&](double s_m) { return FrameAt(s_m); });
  }
  [[nodiscard]] Mesh& Lining() {
    return MeshOf(context_.surfaces.structures.tunnel, chunk_.ground);
  }
  [[nodiscard]] double FootAngle_rad() const { return shape_.TopAngle_rad(kVaultFoot_m); }

  /// The lining's outside, the floor and the faces at the mouths.
  void AddShell(const Stretch& whole) {
    const double outer_m = shape_.radius_m + kLiningThickness_m;
    const double outer_foot_rad = std::asin((kVaultFoot_m - kVaultCentre_m) / outer_m);
    const Outline outer = ArcOutline(outer_m, outer_foot_rad, std::numbers::pi - outer_foot_rad);
    AppendSweptSheet(whole, outer, Lining());
    const double floor_m = shape_.WallAt_m(kTunnelFloor_m);
    AppendSweptSheet(whole, Outline{{-floor_m, kTunnelFloor_m}, {floor_m, kTunnelFloor_m}},
                     Lining());
    Outline ring = ArcOutline(shape_.radius_m, FootAngle_rad(), std::numbers::pi - FootAngle_rad());
    ring.insert(ring.end(), outer.rbegin(), outer.rend());
    if (whole.has_begin) AppendSection(whole.frames.front(), ring, Lining());
    if (whole.has_end) AppendSection(whole.frames.back(), ring, Lining());
  }

  void AddWalkways(const Stretch& whole) {
    const double begin_m = shape_.spread.half_width_m() + kWalkwayBegin_m;
    const double wall_m = shape_.WallAt_m(kWalkwayTop_m) + 0.5 * kLiningThickness_m;
    if (begin_m >= shape_.WallAt_m(kWalkwayTop_m)) return;
    for (const double side : {-1.0, 1.0}) {
      AppendSweptSolid(
          whole, OnSide(RectangleOutline(begin_m, kTunnelFloor_m, wall_m, kWalkwayTop_m), side),
          Lining());
    }
  }

  /// The lining's inside, from niche to niche. In a long tunnel, only the niches about the chunk
  /// are visited.
  void AddWalls() {
    const double spacing_m = tunnel_.niche_spacing_m;
    double begin_s_m = tunnel_.begin_s_m;
    if (spacing_m > 0.0) {
      const auto niche_at = [&](double index) {
        return tunnel_.begin_s_m + (index + 0.5) * spacing_m;
      };
      double index =
          std::max(0.0, std::floor((context_.begin_s_m - tunnel_.begin_s_m) / spacing_m) - 2.0);
      if (index > 0.0) begin_s_m = niche_at(index - 1.0) + kNicheLength_m;
      for (; niche_at(index) + kNicheLength_m < tunnel_.end_s_m; index += 1.0) {
        if (begin_s_m > context_.end_s_m + spacing_m) return;
        AddWall({.begin_s_m = begin_s_m, .end_s_m = niche_at(index)});
        begin_s_m = niche_at(index) + kNicheLength_m;
        AddNiches({.begin_s_m = niche_at(index), .end_s_m = begin_s_m});
      }
    }
    AddWall({.begin_s_m = begin_s_m, .end_s_m = tunnel_.end_s_m});
  }

  void AddInside(const Stretch& stretch, double begin_rad, double end_rad) {
    Outline arc = ArcOutline(shape_.radius_m, begin_rad, end_rad);
    std::ranges::reverse(arc);  // It faces inwards.
    AppendSweptSheet(stretch, arc, Lining());
  }

  void AddWall(const ChainageRange& range) {
    if (!(range.begin_s_m < range.end_s_m)) return;
    const auto stretch = StretchOf(range);
    if (stretch) AddInside(*stretch, FootAngle_rad(), std::numbers::pi - FootAngle_rad());
  }

  /// A piece of the wall with a niche on either side.
  void AddNiches(const ChainageRange& range) {
    const auto stretch = StretchOf(range);
    if (!stretch) return;
    const double low_rad = shape_.TopAngle_rad(kWalkwayTop_m);
    const double high_rad = shape_.TopAngle_rad(kWalkwayTop_m + kNicheHeight_m);
    AddInside(*stretch, FootAngle_rad(), low_rad);
    AddInside(*stretch, high_rad, std::numbers::pi - high_rad);
    AddInside(*stretch, std::numbers::pi - low_rad, std::numbers::pi - FootAngle_rad());
    const double back_m = shape_.WallAt_m(kWalkwayTop_m) + kNicheDepth_m;
    const double top_m = kWalkwayTop_m + kNicheHeight_m;
    for (const double side : {-1.0, 1.0}) {
      const Outline recess = OnSide({{shape_.WallAt_m(kWalkwayTop_m), kWalkwayTop_m},
                                     {back_m, kWalkwayTop_m},
                                     {back_m, top_m},
                                     {shape_.WallAt_m(top_m), top_m}},
                                    side);
      AppendSweptSheet(*stretch, recess, Lining());
      Outline jamb = ArcOutline(shape_.radius_m, low_rad, high_rad);
      for (Eigen::Vector2d& point : jamb) point.x() *= -side;
      jamb.push_back(recess[2]);
      jamb.push_back(recess[1]);
      if (stretch->has_begin) AppendSection(stretch->frames.front(), jamb, Lining());
      if (stretch->has_end) AppendSection(stretch->frames.back(), jamb, Lining());
    }
  }

  void AddPortals() {
    const double half_m = shape_.radius_m + kPortalBeside_m;
    const double top_m = kVaultCentre_m + shape_.radius_m + kPortalAbove_m;
    const double opening_m = shape_.radius_m + kPortalGap_m;
    const double foot_rad = std::asin((kVaultFoot_m - kVaultCentre_m) / opening_m);
    Outline wall = ArcOutline(opening_m, foot_rad, std::numbers::pi - foot_rad);
    const double side_m = wall.back().x();
    wall.insert(wall.begin(), {-side_m, kPortalFoot_m});
    wall.insert(wall.end(), {{side_m, kPortalFoot_m},
                             {half_m, kPortalFoot_m},
                             {half_m, top_m},
                             {-half_m, top_m},
                             {-half_m, kPortalFoot_m}});
    if (track_.Holds(tunnel_.begin_s_m)) {
      Lining().Append(MakeExtrusion(wall, 0.0, kPortalDepth_m), FrameAt(tunnel_.begin_s_m));
    }
    if (track_.Holds(tunnel_.end_s_m)) {
      Lining().Append(MakeExtrusion(wall, -kPortalDepth_m, 0.0), FrameAt(tunnel_.end_s_m));
    }
  }

  void AddHandrails(const Stretch& whole) {
    Mesh& steel = MeshOf(context_.surfaces.structures.tunnel_handrail, chunk_.ground);
    const double height_m = kWalkwayTop_m + kHandrailHeight_m;
    for (const double side : {-1.0, 1.0}) {
      const double y_m = side * (shape_.WallAt_m(height_m) - kRailFromWall_m);
      std::vector<Vector3> centreline;
      for (const Transform& frame : whole.frames) {
        centreline.push_back(frame * Vector3(0.0, y_m, height_m));
      }
      steel.Append(MakeTube(centreline, kRailRadius_m, kRailSides));
    }
  }

  const ChunkContext& context_;
  const TunnelSpec& tunnel_;
  StructureTrack track_;
  TunnelShape shape_;
  Chunk& chunk_;
};

}  // namespace

void AddStructure(const ChunkContext& context, const TunnelSpec& tunnel, Chunk& chunk) {
  TunnelBuilder(context, tunnel, chunk).Add();
}

TunnelVault VaultOf(const WorldTracks& tracks, const TunnelSpec& tunnel) {
  const TunnelShape shape = ShapeOf(tracks, tunnel);
  return {shape.spread.middle_m(), shape.radius_m + kLiningThickness_m};
}

std::vector<ClearedArea> ClearedBy(const WorldTracks& tracks, const TunnelSpec& tunnel) {
  const TunnelShape shape = ShapeOf(tracks, tunnel);
  const double middle_m = shape.spread.middle_m();
  const auto area = [&](double half_m, std::vector<Clearing> cleared) {
    return ClearedArea{.begin_s_m = tunnel.begin_s_m,
                       .end_s_m = tunnel.end_s_m,
                       .right_m = middle_m - half_m,
                       .left_m = middle_m + half_m,
                       .cleared = std::move(cleared)};
  };
  // The ground ends inside the lining.
  return {area(shape.WallAt_m(kTunnelFloor_m) + 0.5 * kLiningThickness_m, {Clearing::kGround}),
          area(shape.radius_m + kPortalBeside_m, {Clearing::kTree, Clearing::kGrass}),
          area(shape.radius_m + kPortalBeside_m, {Clearing::kSupport})};
}

}  // namespace railcast
