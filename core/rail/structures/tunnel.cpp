#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/landform/landform.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structures.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

/// Tolerance of the lining's faces in its cross-section.
constexpr double kVaultTolerance_m = 2e-3;

constexpr double kTunnelFloor_m = -0.72;
/// Beside the outermost axis: behind the ballast's shoulder at 1.75 m.
constexpr double kWalkwayBegin_m = 2.0;
constexpr double kHandrailHeight_m = 1.0;  ///< Height of the handrail above the walkway.
constexpr double kRailRadius_m = 0.02;
constexpr double kRailFromWall_m = 0.08;
constexpr int kRailSides = 8;

constexpr double kNicheLength_m = 2.0;

constexpr double kPortalFoot_m = -1.5;
/// The portal's opening, wider than the lining, so that the lining's surface is the one seen.
constexpr double kPortalGap_m = 0.005;

/// The arc about the vault's centre between two angles, from the right (0) over the top.
Outline ArcOutline(double radius_m, double begin_rad, double end_rad) {
  const double step_rad = 2.0 * std::acos(1.0 - kVaultTolerance_m / radius_m);
  const auto num_steps = std::max(1, static_cast<int>(std::ceil((end_rad - begin_rad) / step_rad)));
  Outline arc;
  for (int i = 0; i <= num_steps; ++i) {
    const double angle_rad = std::lerp(begin_rad, end_rad, 1.0 * i / num_steps);
    arc.emplace_back(-radius_m * std::cos(angle_rad),
                     TunnelShape::kVaultCentre_m + radius_m * std::sin(angle_rad));
  }
  return arc;
}

/// A wall about a mouth, from its right to its left.
struct PortalWall {
  double opening_m{};  ///< Radius.
  double right_m{};
  double left_m{};
  double top_m{};
};

/// Where the wall ends within the opening, it has no foot on that side.
Outline OutlineOf(const PortalWall& wall) {
  const double foot_rad =
      std::asin((TunnelShape::kVaultFoot_m - TunnelShape::kVaultCentre_m) / wall.opening_m);
  const bool has_right_foot = -wall.right_m >= wall.opening_m;
  const bool has_left_foot = wall.left_m >= wall.opening_m;
  const double begin_rad = has_right_foot ? foot_rad : std::acos(-wall.right_m / wall.opening_m);
  const double end_rad = has_left_foot ? foot_rad : std::acos(wall.left_m / wall.opening_m);
  Outline outline = ArcOutline(wall.opening_m, begin_rad, std::numbers::pi - end_rad);
  const double side_m = wall.opening_m * std::cos(foot_rad);
  if (has_right_foot) outline.insert(outline.begin(), {-side_m, kPortalFoot_m});
  if (has_left_foot) {
    outline.insert(outline.end(), {{side_m, kPortalFoot_m}, {wall.left_m, kPortalFoot_m}});
  }
  outline.insert(outline.end(), {{wall.left_m, wall.top_m}, {wall.right_m, wall.top_m}});
  if (has_right_foot) outline.emplace_back(wall.right_m, kPortalFoot_m);
  return outline;
}

/// Builds the part of a tunnel in a chunk. Outlines run from right (-y) to left, over the top.
class TunnelBuilder {
 public:
  TunnelBuilder(const ChunkContext& context, const TunnelSpec& tunnel, Chunk& chunk)
      : context_(context),
        tunnel_(tunnel),
        track_(context, tunnel.track),
        shape_(TunnelShapeOf(TracksOf(context), tunnel)),
        chunk_(chunk) {}

  void Add() {
    const auto whole = StretchOf(RangeOf(tunnel_));
    if (whole) {
      AddShell(*whole);
      AddWalkways(*whole);
    }
    AddWalls();
    if (tunnel_.has_portals) AddPortals();
    if (tunnel_.has_handrail && whole) AddHandrails(*whole);
  }

 private:
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
  [[nodiscard]] double FootAngle_rad() const {
    return shape_.TopAngle_rad(TunnelShape::kVaultFoot_m);
  }

  /// The lining's outside, the floor and the faces at the mouths.
  void AddShell(const Stretch& whole) {
    const double outer_m = shape_.radius_m + TunnelShape::kLiningThickness_m;
    const double outer_foot_rad =
        std::asin((TunnelShape::kVaultFoot_m - TunnelShape::kVaultCentre_m) / outer_m);
    const Outline outer = ArcOutline(outer_m, outer_foot_rad, std::numbers::pi - outer_foot_rad);
    AppendSweep(whole.frames, outer, Lining());
    const double floor_m = shape_.WallAt_m(kTunnelFloor_m);
    AppendSweep(whole.frames, Outline{{-floor_m, kTunnelFloor_m}, {floor_m, kTunnelFloor_m}},
                Lining());
    Outline ring = ArcOutline(shape_.radius_m, FootAngle_rad(), std::numbers::pi - FootAngle_rad());
    ring.insert(ring.end(), outer.rbegin(), outer.rend());
    if (whole.has_begin) AppendSection(whole.frames.front(), ring, Lining());
    if (whole.has_end) AppendSection(whole.frames.back(), ring, Lining());
  }

  void AddWalkways(const Stretch& whole) {
    const double begin_m = shape_.spread.half_width_m() + kWalkwayBegin_m;
    const double wall_m =
        shape_.WallAt_m(TunnelShape::kWalkwayTop_m) + 0.5 * TunnelShape::kLiningThickness_m;
    if (begin_m >= shape_.WallAt_m(TunnelShape::kWalkwayTop_m)) return;
    for (const double side : {-1.0, 1.0}) {
      AppendSweptSolid(
          whole,
          OnSide(RectangleOutline(begin_m, kTunnelFloor_m, wall_m, TunnelShape::kWalkwayTop_m),
                 side),
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
    AppendSweep(stretch.frames, arc, Lining());
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
    const double low_rad = shape_.TopAngle_rad(TunnelShape::kWalkwayTop_m);
    const double high_rad =
        shape_.TopAngle_rad(TunnelShape::kWalkwayTop_m + TunnelShape::kNicheHeight_m);
    AddInside(*stretch, FootAngle_rad(), low_rad);
    AddInside(*stretch, high_rad, std::numbers::pi - high_rad);
    AddInside(*stretch, std::numbers::pi - low_rad, std::numbers::pi - FootAngle_rad());
    const double back_m = shape_.WallAt_m(TunnelShape::kWalkwayTop_m) + TunnelShape::kNicheDepth_m;
    const double top_m = TunnelShape::kWalkwayTop_m + TunnelShape::kNicheHeight_m;
    for (const double side : {-1.0, 1.0}) {
      const Outline recess =
          OnSide({{shape_.WallAt_m(TunnelShape::kWalkwayTop_m), TunnelShape::kWalkwayTop_m},
                  {back_m, TunnelShape::kWalkwayTop_m},
                  {back_m, top_m},
                  {shape_.WallAt_m(top_m), top_m}},
                 side);
      AppendSweep(stretch->frames, recess, Lining());
      Outline jamb = ArcOutline(shape_.radius_m, low_rad, high_rad);
      for (Eigen::Vector2d& point : jamb) point.x() *= -side;
      jamb.push_back(recess[2]);
      jamb.push_back(recess[1]);
      if (stretch->has_begin) AppendSection(stretch->frames.front(), jamb, Lining());
      if (stretch->has_end) AppendSection(stretch->frames.back(), jamb, Lining());
    }
  }

  void AddPortals() {
    if (track_.Holds(tunnel_.begin_s_m)) {
      Lining().Append(MakeExtrusion(PortalAt(TrackTip::kBegin), 0.0, TunnelShape::kPortalDepth_m),
                      FrameAt(tunnel_.begin_s_m));
      AddWings(tunnel_.begin_s_m, 1.0);
    }
    if (track_.Holds(tunnel_.end_s_m)) {
      Lining().Append(MakeExtrusion(PortalAt(TrackTip::kEnd), -TunnelShape::kPortalDepth_m, 0.0),
                      FrameAt(tunnel_.end_s_m));
      AddWings(tunnel_.end_s_m, -1.0);
    }
  }

  /// The wall about a mouth. Where the tunnel goes on in a wider one, it closes that, too, and it
  /// ends half way to a tunnel beside it.
  [[nodiscard]] Outline PortalAt(TrackTip end) const {
    PortalWall wall{.opening_m = shape_.radius_m + kPortalGap_m,
                    .right_m = -shape_.PortalHalfWidth_m(),
                    .left_m = shape_.PortalHalfWidth_m(),
                    .top_m = shape_.PortalTop_m()};
    const std::vector<TunnelMouth> mouths = MouthsAt(TracksOf(context_), tunnel_, end);
    for (const TunnelMouth& mouth : mouths) {
      if (!mouth.goes_on) continue;
      const double outer_m = mouth.radius_m + TunnelShape::kLiningThickness_m;
      wall.right_m = std::min(wall.right_m, mouth.middle_m - outer_m);
      wall.left_m = std::max(wall.left_m, mouth.middle_m + outer_m);
      wall.top_m = std::max(wall.top_m, TunnelShape::kVaultCentre_m + outer_m);
    }
    for (const TunnelMouth& mouth : mouths) {
      if (mouth.goes_on) continue;
      const double half_way_m = 0.5 * mouth.middle_m;
      if (half_way_m > 0.0) wall.left_m = std::min(wall.left_m, half_way_m);
      if (half_way_m < 0.0) wall.right_m = std::max(wall.right_m, half_way_m);
    }
    return OutlineOf(wall);
  }

  /// Walls beside a portal that hold back the hill: from the portal outwards as far as the ground
  /// behind them is higher than that before them.
  /// @param into_hill 1 or -1: the direction along the line.
  void AddWings(double mouth_s_m, double into_hill) {
    if (context_.land == nullptr || !context_.land->has_terrain()) return;
    constexpr double kStep_m = 0.5;
    constexpr double kFarthest_m = 80.0;
    constexpr double kLeastStep_m = 0.1;
    constexpr double kAboveGround_m = 0.15;
    constexpr double kBelowGround_m = 1.0;
    const Transform frame = FrameAt(mouth_s_m);
    const Transform frame_from_chunk = frame.inverse();
    const double middle_m = track_.offset_m(mouth_s_m) + shape_.spread.middle_m();
    const auto ground_m = [&](double s_m, double y_m) {
      return (frame_from_chunk * GroundPoint(context_, s_m, middle_m + y_m)).z();
    };
    for (const double side : {-1.0, 1.0}) {
      Outline top;
      Outline foot;
      // No ground is seen beyond its strip.
      const double edge_m = context_.land->width().At(mouth_s_m, side) - side * middle_m;
      const double farthest_m = std::min(kFarthest_m, edge_m);
      double y_m = shape_.PortalHalfWidth_m() - kStep_m;
      for (; y_m < farthest_m; y_m += kStep_m) {
        const double before_m = ground_m(mouth_s_m - 0.01 * into_hill, side * y_m);
        const double behind_m =
            ground_m(mouth_s_m + into_hill * TunnelShape::kPortalDepth_m, side * y_m);
        top.emplace_back(side * y_m, std::max(before_m, behind_m) + kAboveGround_m);
        foot.emplace_back(side * y_m, std::min(before_m, behind_m) - kBelowGround_m);
        if (y_m > shape_.PortalHalfWidth_m() && behind_m - before_m < kLeastStep_m) break;
      }
      if (top.size() <= 3) continue;
      top.insert(top.end(), foot.rbegin(), foot.rend());
      const double depth_m = into_hill * TunnelShape::kPortalDepth_m;
      Lining().Append(MakeExtrusion(top, std::min(0.0, depth_m), std::max(0.0, depth_m)), frame);
    }
  }

  void AddHandrails(const Stretch& whole) {
    Mesh& steel = MeshOf(context_.surfaces.structures.tunnel_handrail, chunk_.ground);
    const double height_m = TunnelShape::kWalkwayTop_m + kHandrailHeight_m;
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

std::vector<ClearedArea> ClearedBy(const WorldTracks& tracks, const TunnelSpec& tunnel) {
  const TunnelShape shape = TunnelShapeOf(tracks, tunnel);
  const double middle_m = shape.spread.middle_m();
  const auto area = [&](double half_m, std::vector<Clearing> cleared) {
    return ClearedArea{.begin_s_m = tunnel.begin_s_m,
                       .end_s_m = tunnel.end_s_m,
                       .right_m = middle_m - half_m,
                       .left_m = middle_m + half_m,
                       .cleared = std::move(cleared)};
  };
  // The ground ends inside the lining.
  return {area(shape.WallAt_m(kTunnelFloor_m) + 0.5 * TunnelShape::kLiningThickness_m,
               {Clearing::kGround}),
          area(shape.PortalHalfWidth_m(), {Clearing::kTree, Clearing::kGrass}),
          area(shape.PortalHalfWidth_m(), {Clearing::kSupport})};
}

}  // namespace railcast
