#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/echo_tiles.h"
#include "railcast/effects.h"
#include "railcast/outcome.h"

namespace railcast {

/// Whether an echo is that of a retroreflector: a detectable surface brighter than white paper.
[[nodiscard]] inline bool IsRetroreflected(const DetectTile& tile,
                                           std::size_t lane,
                                           float range_min_m) {
  return tile.intensity[lane] > 1.0F && tile.power_ratio[lane] > 1.0F &&
         tile.true_range_m[lane] >= range_min_m &&
         tile.outcome[lane] == static_cast<std::uint32_t>(Outcome::kReturned) &&
         tile.clutter[lane] == kNoClutter;
}

/// Effect `ghost`: points behind retroreflectors, at twice their range.
///
///   ghost's power ratio = q x power ratio of the retroreflector
///   q = ghost_reflectance (aperture / 2)^2 P_min x power ratio of the retroreflector
///
/// Lens and detector form a cat's eye: they send a share of the light that enters the aperture back
/// the way it came, to the retroreflector, and that sends it to the sensor again. The path is twice
/// as long. A retroreflector of effective reflectance rho at range R sends the irradiance
/// power rho / (pi R^2) back to a sensor that emits that power, hence the share
/// ghost_reflectance x aperture's area x rho / (pi R^2) = q goes on its way a second time, and what
/// becomes of it is what became of the first pulse. Air, the retroreflector's share of the beam and
/// pulse stretch therefore count twice, as they do in q. (In units of 1 / P_min, power ratio and
/// rho / R^2 are the same.)
///
/// The ghosts have a label of their own and the outcome `clutter`. They are weaker than their
/// retroreflectors (q is 1e-5 for sheeting at 10 m), so that return modes which report the
/// strongest echo alone hide them.
///
/// Validity: the strongest retroreflector of a beam; light that goes the way a third time (q^2),
/// and light that housing and window scatter back diffusely, are left out. Spots on the window
/// weaken the ghost as if it passed them once. Immutable; thread-safe.
class Ghost {
 public:
  explicit Ghost(const DetectorSpec& spec);

  [[nodiscard]] bool is_on() const { return gain_ > 0.0F; }
  /// Adds ghosts, one at most for each firing. They still have to be detected.
  void AddEchoes(EchoTiles& echoes) const;

 private:
  std::uint32_t label_;
  float power_min_;
  float both_ways_per_m_;  // Extinction of the air.
  float gain_{};           // q over the power ratio; 0 if the effect is off.
  float range_min_m_;
};

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
  float both_ways_per_m_;  // Extinction of the air.
  float share_at_1_rad_;   // The constant of the law with the angle in radians.
  float same_echo_m_;      // Echoes closer together are one.
  float range_min_m_;
};

}  // namespace railcast
