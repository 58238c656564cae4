#pragma once

#include <vector>

#include "core/detect/base/echo_tiles.h"
#include "railcast/effects.h"

namespace railcast {

/// An echo so strong that other beams receive some of its light.
struct HaloSource {
  float x{}, y{}, z{};  ///< Direction of its beam in the sensor frame.
  float range_m{};
  float power_ratio{};
};

/// Effect `halo`: points around retroreflectors, at their range, in beams that point beside them.
///
///   power ratio = strongest of (power ratio of the retroreflector x s(angle)),
///   s(angle) = halo_share_at_1_deg (1 deg / angle)^4, at most 1
///
/// Dust, scratches and lens surfaces scatter a share of the light that falls about with the square
/// of the angle (Harvey's law of scatter with a slope of 2). A beam that points beside a
/// retroreflector lights it by scattered light on the way out, and what returns reaches the
/// receiver by scattered light again, hence the fourth power. With it a retroreflector of power
/// ratio p has a halo of the radius (p halo_share_at_1_deg)^(1/4) degrees. Sources are echoes of
/// surfaces that are brighter than white paper (intensity above 1).
///
/// Validity: a board counts by its nearest edge, not by its size. An echo that is nearer to the
/// beam's own than two sigmas of the pulse is part of that and not added; the amplitude that it
/// adds is neglected. Light that crosses over between channels that fire together is not modelled.
/// Immutable; thread-safe.
class Halo {
 public:
  explicit Halo(const DetectorSpec& spec);

  /// Appends the sources among a tile's echoes.
  void CollectSources(EchoTiles& echoes, std::vector<HaloSource>& sources) const;
  /// Whether a beam of the tile may receive a detectable halo. @pre Its directions are set.
  [[nodiscard]] bool Reaches(const DetectTile& first, const std::vector<HaloSource>& sources) const;
  /// Adds the halos' echoes to a tile's firings: one each at most.
  void AddEchoes(EchoTiles& echoes, const std::vector<HaloSource>& sources) const;

 private:
  std::uint32_t label_;
  float power_min_;
  float share_at_1_rad_;  // The constant of the law with the angle in radians.
  float same_echo_m_;     // Echoes closer together are one.
  float range_min_m_;
};

}  // namespace railcast
