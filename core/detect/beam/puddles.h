#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

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

}  // namespace railcast
