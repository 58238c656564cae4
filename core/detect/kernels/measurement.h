// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_MEASUREMENT_H_
#define RAILCAST_DETECT_MEASUREMENT_H_

#include <limits>

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/lane_random.h"
#include "railcast/outcome.h"

namespace railcast {

/// The model of measurement errors.
enum class RangeErrors { kNone, kIsotropic, kBeam, kSignal };

struct MeasurementParameters {
  std::uint64_t seed{};
  float sigma0_m{};
  float sigma1{};
  float range_min_m{};
  float range_max_m{};
  // Only for RangeErrors::kSignal: sigma^2 = sigma0_m^2 + scale_m^2 / (2 SNR).
  float scale_m{};
  float snr_at_threshold{};
  const float* channel_bias_m{};  ///< By channel.
};

/// What has a factor of its own by which its intensity is measured wrong.
enum class IntensityErrors { kOfEcho, kOfChannel, kOfChannelByRange };

struct IntensityErrorParameters {
  std::uint64_t seed{};
  float log_sigma{};          ///< sqrt(ln(1 + s^2)) for the relative standard deviation s.
  float varying_log_sigma{};  ///< The same; only for kOfChannelByRange.
  float log_range_ratio{};    ///< kGainLogRange, likewise.
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// Completes the outcome that depends on the trace alone and computes the angle of incidence. The
/// caller has set no_surface, ego or returned; surfaces nearer than range_min become near_range.
inline void ApplyHit(DetectTile& tile, float range_min_m) {
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float range_m = tile.true_range_m[i];
    const std::uint32_t before = tile.outcome[i];
    const bool near =
        before == static_cast<std::uint32_t>(Outcome::kReturned) && range_m < range_min_m;
    tile.outcome[i] = near ? static_cast<std::uint32_t>(Outcome::kNearRange) : before;
    // Acos passes NaN on.
    tile.incidence_rad[i] = Acos(tile.cos_incidence[i]);
  }
}

/// Effects `intensity_noise` and `channel_gain`: the intensity is measured wrong by a log-normal
/// factor with mean 1 and the relative standard deviation s that the sensor's spec states:
///
///   intensity x exp(g n - g^2 / 2),   g^2 = ln(1 + s^2),   n ~ N(0, 1)
///
/// with an n for each echo, or for each channel, the same in every frame. A channel may have
/// another factor by range (kOfChannelByRange), of a deviation h. Its n is a wave over ln(R), R in
/// metres:
///
///   n(R) = b cos(d x) + c sin(d x),   x = ln(R) / l,   b, c, d ~ N(0, 1)
///
/// (l: log_range_ratio). Over channels, it is normal at each range, and that at ranges x apart has
/// the correlation E cos(d x) = exp(-x^2 / 2). Power, and with it detection and range noise, is
/// what arrives. Log-normal, so that no intensity is < 0.
template <IntensityErrors kErrors>
inline void ScaleIntensity(DetectTile& tile, const IntensityErrorParameters& parameters) {
  constexpr bool kIsOfChannel = kErrors != IntensityErrors::kOfEcho;
  const LaneKey key{parameters.seed,
                    kIsOfChannel ? RandomUse::kChannelGain : RandomUse::kIntensityNoise,
                    kIsOfChannel ? 0U : tile.frame};
  const float g = parameters.log_sigma;
  const float h = parameters.varying_log_sigma;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const Words words = kIsOfChannel ? LaneWords(key, tile.channel[i], 0)
                                     : LaneWords(key, tile.firing[i], tile.echo[i]);
    const Normals normals = LaneNormals(words);
    float exponent = g * normals.a - 0.5F * g * g;
    if constexpr (kErrors == IntensityErrors::kOfChannelByRange) {
      const float turns_per_log = 0.15915494F / parameters.log_range_ratio;  // 1 / (2 pi)
      const float turns = normals.d * (turns_per_log * Log(tile.true_range_m[i]));
      float cosine{};
      float sine{};
      CosSinTurn(WithinHalfATurn(turns), cosine, sine);
      exponent += h * (normals.b * cosine + normals.c * sine) - 0.5F * h * h;
    }
    tile.intensity[i] *= Exp(exponent);
  }
}

/// The last step of every rung, which computes the measured position. With effect `noise`:
///
///   sigma = noise_sigma0 + noise_sigma1 * R
///   isotropic (as published): position = R * direction + sigma * (n1, n2, n3), n ~ N(0, 1)
///   beam:                     position = (R + sigma * n1) * direction
///
/// On all physical rungs (kSignal), with effects `range_noise` and `channel_bias`
/// (docs/physics.md 5):
///
///   position = (R + shift of the peak + bias of the channel + sigma * n1) * direction
///   sigma    = hypot(range_noise_floor, range_noise_scale / sqrt(2 SNR)),
///   SNR      = SNR_t x power ratio
///
/// R is the true range; the measured range is |position|. Without noise, position = R * direction.
/// Echoes whose measured range is outside the gate [range_min, range_max] become near_range or
/// out_of_range.
template <RangeErrors kShape>
inline void ApplyMeasurement(DetectTile& tile, const MeasurementParameters& parameters) {
  constexpr RandomUse kUse =
      kShape == RangeErrors::kSignal ? RandomUse::kRangeNoise : RandomUse::kNoise;
  const LaneKey key{parameters.seed, kUse, tile.frame};
  const MeasurementParameters p = parameters;  // The copy cannot alias the tile.
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  // A loop of its own: the lookup in a table that might alias the tile prevents vectorisation.
  alignas(64) float shift_m[kTileSize];
  if constexpr (kShape == RangeErrors::kSignal) {
    for (std::size_t i = 0; i < tile.num_rays; ++i) {
      shift_m[i] = tile.peak_shift_m[i] + p.channel_bias_m[tile.channel[i]];
    }
  }
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float true_range_m = tile.true_range_m[i];
    float range_m = true_range_m;
    float x = true_range_m * tile.direction_x[i];
    float y = true_range_m * tile.direction_y[i];
    float z = true_range_m * tile.direction_z[i];
    if constexpr (kShape != RangeErrors::kNone) {
      float sigma_m = p.sigma0_m + p.sigma1 * true_range_m;
      if constexpr (kShape == RangeErrors::kSignal) {
        constexpr float kLeast = 1e-30F;  // Avoids 0 / 0 for echoes without power.
        const float ratio = tile.power_ratio[i] > kLeast ? tile.power_ratio[i] : kLeast;
        const float snr = p.snr_at_threshold * ratio;
        sigma_m = std::sqrt(p.sigma0_m * p.sigma0_m + p.scale_m * p.scale_m / (2.0F * snr));
      }
      const Normals n = LaneNormals(LaneWords(key, tile.firing[i], tile.echo[i]));
      if constexpr (kShape == RangeErrors::kIsotropic) {
        x += sigma_m * n.a;
        y += sigma_m * n.b;
        z += sigma_m * n.c;
        range_m = std::sqrt(x * x + y * y + z * z);
      } else {
        if constexpr (kShape == RangeErrors::kSignal) {
          range_m += shift_m[i];
        }
        range_m += sigma_m * n.a;
        x = range_m * tile.direction_x[i];
        y = range_m * tile.direction_y[i];
        z = range_m * tile.direction_z[i];
      }
    }
    const std::uint32_t before = tile.outcome[i];
    const bool measured = before == static_cast<std::uint32_t>(Outcome::kReturned) ||
                          before == static_cast<std::uint32_t>(Outcome::kClutter);
    const bool beyond = range_m > p.range_max_m;
    const bool short_of = range_m < p.range_min_m;
    const std::uint32_t gated = beyond     ? static_cast<std::uint32_t>(Outcome::kOutOfRange)
                                : short_of ? static_cast<std::uint32_t>(Outcome::kNearRange)
                                           : before;
    const bool has_point = measured && range_m >= p.range_min_m && range_m <= p.range_max_m;
    tile.outcome[i] = measured ? gated : before;
    tile.range_m[i] = has_point ? range_m : kNaN;
    tile.x[i] = has_point ? x : kNaN;
    tile.y[i] = has_point ? y : kNaN;
    tile.z[i] = has_point ? z : kNaN;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_MEASUREMENT_H_
