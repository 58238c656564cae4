#include "core/rail/clearance/tunnel_shape.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kShortestDropper_m = 0.3;

/// Whether the contact line passes below it.
template <class Structure>
constexpr bool kIsAboveTheWire =
    std::is_same_v<Structure, TunnelSpec> || std::is_same_v<Structure, OverbridgeSpec>;

/// Half the width beside the outermost axis at the vault's widest: a train (1.6 m), a gap (0.5 m)
/// and a way of escape 1.2 m wide.
constexpr double kRoomBesideAxis_m = 3.3;
/// Between the messenger wire and the lining.
constexpr double kWireClearance_m = 0.3;
/// Without a contact line: above the wagons' 4.28 m.
constexpr double kRoomAbove_m = 4.8;

constexpr double kPortalBeside_m = 2.5;
constexpr double kPortalAbove_m = 1.5;

/// Ground beside the niches keeps this distance from them.
constexpr double kNicheCover_m = 0.15;

}  // namespace

bool HasContactLine(const WorldSpec& world) {
  return world.catenary.enabled &&
         std::any_of(world.tracks.begin(), world.tracks.end(),
                     [](const TrackSpec& track) { return track.electrified; });
}

double LeastSystemHeight_m(const WorldSpec& world) {
  const CatenarySpec& spec = world.catenary;
  const double sag_m =
      kWireWeight_n_per_m * spec.max_span_m * spec.max_span_m / (8.0 * kMessengerTension_n);
  return sag_m - kContactPresag * spec.max_span_m + kShortestDropper_m;
}

void CheckSystemHeight(const WorldSpec& world) {
  if (!HasContactLine(world)) return;
  const CatenarySpec& spec = world.catenary;
  const double needed_m = LeastSystemHeight_m(world);
  if (spec.system_height_m >= needed_m) return;
  throw InputError({{"/catenary/system_height_m",
                     "must be >= " + NumberText(needed_m) +
                         ", the messenger's sag over max_span_m and a shortest dropper",
                     NumberText(spec.system_height_m)}});
}

double SystemHeightAt_m(const WorldSpec& world, double s_m) {
  const double span_m = world.catenary.max_span_m;
  const bool is_low = std::ranges::any_of(world.structures, [&](const StructureSpec& structure) {
    return std::visit(
        [&]<class Structure>(const Structure& spec) {
          if constexpr (kIsAboveTheWire<Structure>) {
            return s_m > spec.begin_s_m - span_m && s_m < spec.end_s_m + span_m;
          }
          return false;
        },
        structure);
  });
  // Longer spans sag more than the usual ones.
  const double low_m = std::max(kLowSystemHeight_m, LeastSystemHeight_m(world));
  return is_low ? std::min(world.catenary.system_height_m, low_m) : world.catenary.system_height_m;
}

double TunnelShape::WallAt_m(double height_m) const {
  const double above_m = height_m - kVaultCentre_m;
  return std::sqrt(std::max(0.0, radius_m * radius_m - above_m * above_m));
}

double TunnelShape::TopAngle_rad(double height_m) const {
  return std::asin(std::clamp((height_m - kVaultCentre_m) / radius_m, -1.0, 1.0));
}

double TunnelShape::PortalHalfWidth_m() const {
  return radius_m + kPortalBeside_m;
}

double TunnelShape::PortalTop_m() const {
  return kVaultCentre_m + radius_m + kPortalAbove_m;
}

double TunnelShape::ReachBeside_m() const {
  return std::max(radius_m + kLiningThickness_m, WallAt_m(kWalkwayTop_m) + kNicheDepth_m) +
         kNicheCover_m;
}

double TunnelShape::MiddleOfLining_m(double y_m) const {
  const double middle_m = radius_m + 0.5 * kLiningThickness_m;
  return std::max(kVaultCentre_m + std::sqrt(std::max(0.0, middle_m * middle_m - y_m * y_m)),
                  kWalkwayTop_m + kNicheHeight_m + kNicheCover_m);
}

TunnelShape TunnelShapeOf(const WorldTracks& tracks, const TunnelSpec& tunnel) {
  const WorldSpec& world = tracks.world;
  TunnelShape shape{.spread = SpreadOf(tracks, tunnel, kSharedTunnel_m), .radius_m = 0.0};
  const double above_m = HasContactLine(world)
                             ? world.catenary.contact_height_m +
                                   SystemHeightAt_m(world, tunnel.begin_s_m) + kWireClearance_m
                             : kRoomAbove_m;
  const double half_m = shape.spread.half_width_m();
  shape.radius_m = tunnel.radius_m.value_or(std::max(
      half_m + kRoomBesideAxis_m, std::hypot(half_m, above_m - TunnelShape::kVaultCentre_m)));
  return shape;
}

std::vector<TunnelMouth> MouthsAt(const WorldTracks& tracks,
                                  const TunnelSpec& tunnel,
                                  TrackTip end) {
  constexpr double kSame_m = 0.05;
  const double s_m = end == TrackTip::kBegin ? tunnel.begin_s_m : tunnel.end_s_m;
  std::vector<TunnelMouth> mouths;
  std::optional<TunnelShape> own;
  for (const StructureSpec& structure : tracks.world.structures) {
    const auto* other = std::get_if<TunnelSpec>(&structure);
    if (other == nullptr || other == &tunnel || *other == tunnel) continue;
    const bool begins = std::abs(other->begin_s_m - s_m) < kSame_m;
    if (!begins && !(std::abs(other->end_s_m - s_m) < kSame_m)) continue;
    const TrackCourse* track = tracks.CourseOf(tunnel.track);
    const TrackCourse* other_track = tracks.CourseOf(other->track);
    if (track == nullptr || other_track == nullptr) continue;
    if (!own) own = TunnelShapeOf(tracks, tunnel);
    const TunnelShape shape = TunnelShapeOf(tracks, *other);
    const TunnelMouth mouth{.goes_on = begins != (end == TrackTip::kBegin),
                            .middle_m = other_track->OffsetWithin_m(s_m) + shape.spread.middle_m() -
                                        track->OffsetWithin_m(s_m) - own->spread.middle_m(),
                            .radius_m = shape.radius_m};
    const double reach_m = mouth.goes_on ? own->radius_m + shape.radius_m
                                         : own->PortalHalfWidth_m() + shape.PortalHalfWidth_m();
    if (std::abs(mouth.middle_m) < reach_m) mouths.push_back(mouth);
  }
  return mouths;
}

bool GoesOn(const WorldTracks& tracks, const TunnelSpec& tunnel, TrackTip end) {
  return std::ranges::any_of(MouthsAt(tracks, tunnel, end), &TunnelMouth::goes_on);
}

}  // namespace railcast
