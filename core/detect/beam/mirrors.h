#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/detect/base/detect_tile.h"
#include "railcast/effects.h"
#include "railcast/material.h"
#include "railcast/ray_caster.h"
#include "railcast/transform.h"

namespace railcast {

inline constexpr std::size_t kNumPuddleWaves = 16;

/// The waves of Puddles in the frame of a tile's rays.
struct PuddleWaves {
  float x[kNumPuddleWaves], y[kNumPuddleWaves], z[kNumPuddleWaves];  ///< Turns per metre.
  float phase[kNumPuddleWaves];                                      ///< Turns at the origin.
  float least{};  ///< Water stands where the sum of the waves exceeds this.
};

/// Where puddles are: the places at which a random field over the plane is high,
///
///   g = sum over waves of a cos(2 pi (k p + phi)) > the normal quantile of 1 - share
///
/// The 16 waves are of equal variance a^2 / 2 = 1/16 and of wavelengths from 4 to 16 m in equal
/// ratios; their horizontal directions and phases are drawn once. Over all seeds, g has mean 0 and
/// variance 1 and is normal but for its kurtosis of -1.5 / 16, which changes the share by 0.002 at
/// most. Puddles are some metres long and do not move. Wavelengths are ours.
class Puddles {
 public:
  Puddles(std::uint64_t seed, double share);

  [[nodiscard]] PuddleWaves WavesAt(const Transform& world_from_window) const;

  static constexpr double kShortest_m = 4.0;
  static constexpr double kLongest_m = 16.0;

 private:
  struct Wave {
    Vector3 turns_per_m;
    double phase_turns{};
  };
  std::array<Wave, kNumPuddleWaves> waves_;
  float least_;
};

/// Whether water stands on ground at this place that can hold it.
[[nodiscard]] bool IsUnderWater(const PuddleWaves& waves, const float (&place_m)[3]);

/// A material as a mirror, at a sensor's wavelength.
struct MirrorOptics {
  bool is_smooth{};        ///< It has a `height_rms_um`.
  float phase_rad{};       ///< 4 pi height_rms / wavelength.
  bool holds_puddles{};    ///< And the weather has puddles.
  float soaked_diffuse{};  ///< Diffuse reflectance under water.
};

/// The mirrors of a scene, in the frame of its rays.
struct MirrorScene {
  const std::vector<MirrorOptics>* optics{};  ///< By material.
  const std::vector<Surface>* surfaces{};
  PuddleWaves puddles;
  float up[3]{};       ///< The world's vertical.
  float snow_cover{};  ///< Share of level mirrors that snow covers.
};

/// A beam that meets a mirror and goes on from it.
struct MirrorHit {
  std::size_t lane{};
  float there_and_back{};  ///< Share of the power that both reflections leave.
  float normal[3]{};       ///< Unit length, on the side of the sensor.
  // Where the reflected ray starts, from the place of the hit.
  float lift_m{};   ///< Along the normal.
  float ahead_m{};  ///< Then along the reflected direction.
};

/// What mirrors, part of effect `mirror_paths`:
///
///   smooth surfaces   m = exp(-(phase cos)^2)      the coherent share of a rough surface
///                                                  (Rayleigh's parameter; Beckmann, Spizzichino)
///   puddles           m = 1                        level, on ground less steep than 10 deg
///   reflected         m F,  F = F0 + (1 - F0) (1 - cos)^5          (Schlick 1994)
///                           water: Fresnel's equations, n = 1.33
///
/// and what is left of such a surface's own response:
///
///   smooth surfaces   diffuse x (1 - m (1 - ((1 - F) / (1 - F0))^2)),  lobe x (1 - m)
///   puddles           rho_soaked (1 - F)^2 cos,  no lobe
///
/// Light that a diffuse layer scatters passes the surface above it twice, and less of it at grazing
/// incidence. Immutable; thread-safe.
class Mirrors {
 public:
  Mirrors(const DetectorSpec& spec, const std::vector<Material>& materials);

  /// The mirrors among a frame's surfaces; absent if there are none. Refers to `surfaces` and
  /// to this object.
  [[nodiscard]] std::optional<MirrorScene> Among(const std::vector<Surface>& surfaces,
                                                 const Transform& window_from_world) const;

  /// Height of the water of puddles above the ground that they cover. Ours.
  static constexpr float kPuddleDepth_m = 0.03F;

 private:
  std::vector<MirrorOptics> optics_;
  std::optional<Puddles> puddles_;
  float snow_cover_;
};

/// Takes from the optics of the surfaces that a tile's rays hit what mirrors reflect, before
/// Detector::Respond() uses them.
/// @param tile The hits of `rays`: ResolveHits(), incidence and spread have been applied to it.
/// @param hits If not null, gets the beams that go on from a mirror.
void DimMirrors(const MirrorScene& scene,
                const RayTile& rays,
                DetectTile& tile,
                std::vector<MirrorHit>* hits = nullptr);

}  // namespace railcast
