#pragma once

#include <cstdint>
#include <vector>

#include "core/detect/base/echo_tiles.h"
#include "core/detect/detector/detector.h"
#include "railcast/effects.h"
#include "railcast/ray_caster.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// The cloud that a train whirls up: as dense as at its rear beside and under the whole vehicle,
/// thinning out behind it. In the frame of the rays.
struct SprayCloud {
  /// The middle of the vehicle's rear end at the height of its wheels' foot, at the stamp.
  float rear[3]{};
  float way[3]{};  ///< How far it moves until the last firing. It does not turn.
  // Unit vectors.
  float back[3]{};  ///< Against the direction of travel.
  float left[3]{};
  float up[3]{};
  float body_m{};  ///< Length of the vehicle, from `rear` against `back`.
  float half_width_m{};
  float height_m{};
  float decay_m{};           ///< Behind the vehicle, the density falls to 1/e over this length.
  float extinction_per_m{};  ///< At the vehicle.
};

/// The part of a ray inside a cloud.
struct SprayPath {
  float begin_m{};
  float end_m{};       ///< Not after begin_m if the ray misses the cloud.
  float back_m{};      ///< Place along `back` at range 0.
  float back_per_m{};  ///< Its change per metre of range.
};

/// The part of a ray from `origin` along the unit vector `direction` that is inside a cloud at the
/// stamp. Of a later ray, `origin` must be moved back by as much as the cloud has moved on.
[[nodiscard]] SprayPath PathIn(const SprayCloud& cloud,
                               const float (&origin)[3],
                               const float (&direction)[3]);
/// Extinction at a place of the path.
[[nodiscard]] float ExtinctionAt_per_m(const SprayCloud& cloud,
                                       const SprayPath& path,
                                       float range_m);
/// Optical depth from the ray's origin to a range, in closed form.
[[nodiscard]] float OpticalDepth(const SprayCloud& cloud, const SprayPath& path, float range_m);

/// Extinction of the cloud at a train of this speed: that of the weather at 100 km/h, in proportion
/// to the wetness or snow cover of the ground (whichever is greater) and to the square of the
/// speed.
[[nodiscard]] double SprayExtinction_per_m(const WeatherSpec& weather, double speed_mps);

/// Whether moving trains whirl anything up.
[[nodiscard]] bool HasSpray(const DetectorSpec& spec);

/// Effect `spray`: water and powder snow that moving trains whirl up.
///
///   echoes behind or inside: power ratio x exp(-2 t(r)),  t = optical depth from the sensor
///   one echo of the cloud per beam, in front of the beam's first surface:
///     P(range < r) = (1 - exp(-2 t(r))) / (1 - exp(-2 t(end)))
///     intensity = pi a / 65 sr x c tau / 2 x E,  E exponentially distributed, mean 1
///
/// with a the extinction there. The range is that of a photon scattered back, the mean intensity
/// that of the droplets within a pulse length (as for fog, docs/physics.md 4.3); it fluctuates
/// since clouds of spray are clumps. docs/effects.md says what the numbers rest on. Immutable;
/// thread-safe.
class Spray {
 public:
  explicit Spray(const DetectorSpec& spec);

  /// Weakens a tile's echoes and adds those of clouds.
  /// @param rays The central rays; lane i is firing i of `echoes.first`.
  void Apply(const RayTile& rays,
             const std::vector<SprayCloud>& clouds,
             const Detector& detector,
             EchoTiles& echoes) const;

 private:
  /// What one beam meets of all clouds.
  struct Passage;
  void AddCloudEcho(std::size_t beam,
                    const Passage& passage,
                    const Detector& detector,
                    EchoTiles& echoes) const;

  std::uint64_t seed_;
  std::uint32_t label_;
  float range_min_m_;
  float range_max_m_;
  float reflectance_m_;  // pi / 65 sr x c tau / 2: effective reflectance per extinction.
};

/// The span of time from a frame's first firing to its last.
struct ScanSpan {
  std::int64_t stamp_ns{};
  std::uint32_t duration_ns{};
};

/// The clouds of spray during a scan: one for every moving wagon, with which it moves. They reach
/// 0.5 m beyond its sides and 3 m up, and behind it thin out over the distance that it travels
/// within a second.
[[nodiscard]] std::vector<SprayCloud> SprayCloudsOf(const World& world,
                                                    const WeatherSpec& weather,
                                                    const ScanSpan& span,
                                                    const Transform& window_from_world);

}  // namespace railcast
