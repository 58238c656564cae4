#pragma once

#include <vector>

#include "core/rail/network/world_tracks.h"
#include "railcast/structures.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Weight, tension and sag of the contact line (docs/physics.md 7.2): a Bz50 messenger wire carries
/// an AC-100 contact wire at 10 kN.
inline constexpr double kWireWeight_n_per_m = 13.0;
inline constexpr double kMessengerTension_n = 10e3;
inline constexpr double kContactTension_n = 10e3;
inline constexpr double kContactPresag = 1.0 / 1000.0;  ///< Sag as a fraction of the span.

/// Whether any track has a contact line.
[[nodiscard]] bool HasContactLine(const WorldSpec& world);

/// The least system height with which the messenger wire, sagging over the longest span, stays 0.3
/// m above the contact wire.
[[nodiscard]] double LeastSystemHeight_m(const WorldSpec& world);

/// @throws InputError if the messenger wire would sag to less than 0.3 m above the contact wire:
///   "/catenary/system_height_m: rule (got value)", relative to the world's JSON object.
void CheckSystemHeight(const WorldSpec& world);

/// System height of the contact line in tunnels and below bridges, if it is higher elsewhere.
/// The messenger sags 0.69 m in a span of 65 m and must stay 0.3 m above the contact wire.
inline constexpr double kLowSystemHeight_m = 1.1;

/// System height of the contact line at a chainage: lower in tunnels and below bridges, and from
/// one span before to one span behind them.
[[nodiscard]] double SystemHeightAt_m(const WorldSpec& world, double s_m);

/// A tunnel's cross-section: y from its middle, z above top of rail.
struct TunnelShape {
  /// The vault is a circle about this height, down to its foot.
  static constexpr double kVaultCentre_m = 1.8;
  static constexpr double kVaultFoot_m = -0.9;
  static constexpr double kLiningThickness_m = 0.5;
  static constexpr double kWalkwayTop_m = 0.0;
  static constexpr double kNicheHeight_m = 2.2;
  static constexpr double kNicheDepth_m = 0.8;   ///< From the wall at the niche's foot.
  static constexpr double kPortalDepth_m = 1.0;  ///< Thickness of the wall about the mouth.

  TrackSpread spread;
  double radius_m{};

  /// Half the width inside at a height.
  [[nodiscard]] double WallAt_m(double height_m) const;
  [[nodiscard]] double TopAngle_rad(double height_m) const;
  [[nodiscard]] double PortalHalfWidth_m() const;
  [[nodiscard]] double PortalTop_m() const;
  /// No part of the tunnel but its portals is farther from its middle.
  [[nodiscard]] double ReachBeside_m() const;
  /// A height within the lining, or above the niches beside it. @pre |y_m| <= ReachBeside_m()
  [[nodiscard]] double MiddleOfLining_m(double y_m) const;
};

[[nodiscard]] TunnelShape TunnelShapeOf(const WorldTracks& tracks, const TunnelSpec& tunnel);

/// Another tunnel that has a mouth where a tunnel has one, and touches it there.
struct TunnelMouth {
  /// Whether the tunnel goes on in it: it begins where that ends, or ends where that begins. Else
  /// it lies beside it.
  bool goes_on{};
  double middle_m{};  ///< Left of the tunnel's own middle.
  double radius_m{};
};
/// @param end Which of the tunnel's own mouths.
[[nodiscard]] std::vector<TunnelMouth> MouthsAt(const WorldTracks& tracks,
                                                const TunnelSpec& tunnel,
                                                TrackTip end);
/// Whether a tunnel goes on in another one at one of its ends.
[[nodiscard]] bool GoesOn(const WorldTracks& tracks, const TunnelSpec& tunnel, TrackTip end);

}  // namespace railcast
