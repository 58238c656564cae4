#include "core/rail/landform/ground_rise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "core/rail/landform/landform.h"

namespace railcast {
namespace {

/// Portals are 1 m deep, and rows of the ground 0.5 m apart: the step between two of them about
/// this place is inside the portal.
constexpr double kHillBegin_m = 0.5 * TunnelShape::kPortalDepth_m;
/// Where a tunnel goes on as another one, so does the hill.
constexpr double kHillOverlap_m = 1e-3;
/// The portal's upper edge is higher than the ground behind it.
constexpr double kPortalShows_m = 0.2;
/// So far before and in a mouth nothing joins the ground above.
constexpr double kMouth_m = 2.0;

}  // namespace

TunnelHills::TunnelHills(const ChunkContext& context, double begin_s_m, double end_s_m)
    : context_(&context), ditch_m_(context.spec.terrain.has_ditches ? kDitchWidth_m : 0.0) {
  if (context.land == nullptr || !context.land->has_terrain()) return;
  const WorldTracks tracks = TracksOf(context);
  for (const StructureSpec& structure : context.spec.structures) {
    const auto* tunnel = std::get_if<TunnelSpec>(&structure);
    if (tunnel == nullptr || tunnel->end_s_m < begin_s_m || tunnel->begin_s_m > end_s_m) continue;
    const TrackCourse* track = tracks.CourseOf(tunnel->track);
    if (track == nullptr) continue;
    const auto top_of_rail_m = [&](double s_m) {
      const Transform world_from_track = track->WorldFromTrack(context.alignment, s_m);
      return (context.chunk_from_world * world_from_track).translation().z();
    };
    const bool begin_goes_on = GoesOn(tracks, *tunnel, TrackTip::kBegin);
    const bool end_goes_on = GoesOn(tracks, *tunnel, TrackTip::kEnd);
    tunnels_.push_back(
        {.spec = tunnel,
         .track = track,
         .shape = TunnelShapeOf(tracks, *tunnel),
         .begin_h_m = top_of_rail_m(tunnel->begin_s_m),
         .end_h_m = top_of_rail_m(tunnel->end_s_m),
         .begin_goes_on = begin_goes_on,
         .end_goes_on = end_goes_on,
         .hill_begin_s_m = tunnel->begin_s_m + (begin_goes_on ? -kHillOverlap_m : kHillBegin_m),
         .hill_end_s_m = tunnel->end_s_m - (end_goes_on ? -kHillOverlap_m : kHillBegin_m)});
  }
}

bool TunnelHills::AnyIn(double from_s_m, double to_s_m) const {
  return std::ranges::any_of(tunnels_, [&](const Tunnel& tunnel) {
    return tunnel.spec->begin_s_m <= to_s_m && tunnel.spec->end_s_m >= from_s_m;
  });
}

double TunnelHills::Beside_m(const Tunnel& tunnel, double s_m, double d_m) {
  return std::abs(d_m - tunnel.track->OffsetAt(s_m).d_m - tunnel.shape.spread.middle_m());
}

TunnelHills::Place TunnelHills::PlaceOf(double s_m, double d_m) const {
  for (const Tunnel& tunnel : tunnels_) {
    const double first_s_m = tunnel.spec->begin_s_m - (tunnel.begin_goes_on ? 0.0 : kMouth_m);
    const double last_s_m = tunnel.spec->end_s_m + (tunnel.end_goes_on ? 0.0 : kMouth_m);
    if (s_m < first_s_m || s_m > last_s_m) continue;
    if (Beside_m(tunnel, s_m, d_m) > tunnel.shape.ReachBeside_m()) continue;
    return HasHill(tunnel, s_m) ? Place::kOver : Place::kMouth;
  }
  return Place::kBeside;
}

bool TunnelHills::IsInside(double s_m, double d_m) const {
  return std::ranges::any_of(tunnels_, [&](const Tunnel& tunnel) {
    return s_m >= tunnel.spec->begin_s_m && s_m <= tunnel.spec->end_s_m &&
           Beside_m(tunnel, s_m, d_m) <= tunnel.shape.ReachBeside_m();
  });
}

double TunnelHills::Limit_m(const Tunnel& tunnel, double behind_m, double beside_m) const {
  // The bottom of the cutting before the mouth.
  const double formation_m = tunnel.shape.spread.half_width_m() + kFormationEdge_m + ditch_m_;
  const auto cone_m = [&](double foot_m, double height_m) {
    return height_m + kCutAndFillSlope * std::hypot(std::max(0.0, beside_m - foot_m), behind_m);
  };
  if (!tunnel.spec->has_portals) {
    return cone_m(formation_m, -CrossSection::kFormationDepth_m);
  }
  const double wall_m = tunnel.shape.PortalHalfWidth_m();
  const double wall_top_m = tunnel.shape.PortalTop_m() - kPortalShows_m;
  // The wings fall at 1:1.5 from the portal's upper edge to the slope of the cutting.
  const double above_m = wall_top_m + CrossSection::kFormationDepth_m;
  const double meet_m = 0.5 * (above_m / kCutAndFillSlope + wall_m + formation_m);
  const double meet_h_m =
      kCutAndFillSlope * (meet_m - formation_m) - CrossSection::kFormationDepth_m;
  return std::min(cone_m(wall_m, wall_top_m),
                  meet_h_m + kCutAndFillSlope * std::hypot(beside_m - meet_m, behind_m));
}

double TunnelHills::Height_m(const CrossSection& section,
                             double s_m,
                             double d_m,
                             const GroundHeights& without) const {
  const bool has_hill =
      std::ranges::any_of(tunnels_, [&](const Tunnel& tunnel) { return HasHill(tunnel, s_m); });
  if (!has_hill) return without.built_m;
  const auto is_outside = [&](double track_d_m) {
    constexpr double kSameTrack_m = 0.1;
    return std::ranges::none_of(tunnels_, [&](const Tunnel& tunnel) {
      return HasHill(tunnel, s_m) &&
             Beside_m(tunnel, s_m, track_d_m) <= tunnel.shape.spread.half_width_m() + kSameTrack_m;
    });
  };
  const double to_others_m = section.DistanceFromTracksIf_m(d_m, is_outside) - kFormationEdge_m;
  const double cut_m = kCutAndFillSlope * std::max(0.0, to_others_m - ditch_m_);
  const double fill_m = CutAndFill_m(-std::numeric_limits<double>::infinity(),
                                     section.DistanceFromTracks_m(d_m) - kFormationEdge_m);
  const double formation_m = section.FormationHeight_m(d_m);
  const double formation_h_m = section.PointAt(d_m, formation_m).z();
  double height_m = std::max(std::min(without.terrain_m, cut_m), fill_m);
  for (const Tunnel& tunnel : tunnels_) {
    if (!HasHill(tunnel, s_m)) continue;
    const double beside_m = Beside_m(tunnel, s_m, d_m);
    const double depth_m = tunnel.spec->has_portals ? TunnelShape::kPortalDepth_m : 0.0;
    const double from_begin_m = std::max(0.0, s_m - tunnel.spec->begin_s_m - depth_m);
    const double from_end_m = std::max(0.0, tunnel.spec->end_s_m - depth_m - s_m);
    if (!tunnel.begin_goes_on) {
      height_m = std::min(
          height_m, Limit_m(tunnel, from_begin_m, beside_m) + tunnel.begin_h_m - formation_h_m);
    }
    if (!tunnel.end_goes_on) {
      height_m = std::min(height_m,
                          Limit_m(tunnel, from_end_m, beside_m) + tunnel.end_h_m - formation_h_m);
    }
  }
  for (const Tunnel& tunnel : tunnels_) {
    if (!HasHill(tunnel, s_m)) continue;
    const double beside_m = Beside_m(tunnel, s_m, d_m);
    const double reach_m = tunnel.shape.ReachBeside_m();
    const double lining_m = tunnel.shape.MiddleOfLining_m(std::min(beside_m, reach_m)) -
                            kCutAndFillSlope * std::max(0.0, beside_m - reach_m) +
                            tunnel.track->LiftAt(context_->alignment, s_m).h_m - formation_m;
    const bool is_over = beside_m <= reach_m;
    height_m = std::max(height_m, is_over ? lining_m : std::min(lining_m, cut_m));
  }
  return height_m;
}

}  // namespace railcast
