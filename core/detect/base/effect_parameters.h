#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/random.h"
#include "core/detect/base/detect_tile.h"
#include "railcast/ray_caster.h"

namespace railcast {

// Parameters that several kernels or the beam tracer need. They are float32 and derived once from
// the specs. The parameters of a single effect are defined above its loop.

/// The part of a random key that all firings of a tile share.
struct DrawKey {
  std::uint64_t seed{};
  RandomUse use{};
  std::uint32_t block{};
};

/// The reference directions and the width of a tile's beams.
struct BeamFrame {
  float up[3]{0.0F, 0.0F, 1.0F};        ///< The sensor's z axis in the frame of the rays.
  float vertical[3]{0.0F, 0.0F, 1.0F};  ///< The world's vertical in the frame of the rays.
  float sigma_h_rad{};                  ///< Standard deviation of the profile, horizontal.
  float sigma_v_rad{};                  ///< Standard deviation of the profile, vertical.
};

/// Cosine and sine of the angles by which the firings' patterns of sub-rays are turned, by lane.
struct PatternTurns {
  float cosine[kTileSize], sine[kTileSize];
};

/// The sub-rays of a beam and the angle by which they are turned about its axis.
struct SubRayAim {
  std::size_t num{};       ///< The number of sub-rays.
  const float* h{};        ///< Horizontal offsets in standard deviations of the profile.
  const float* v{};        ///< Vertical offsets.
  float largest_offset{};  ///< The largest distance from the axis.
  float cosine{}, sine{};
};

struct PointingParameters {
  std::uint64_t seed{};
  float sigma_rad{};
};

inline constexpr std::size_t kNumFogWaves = 12;

/// The waves of FogPatches in the frame of a tile's rays.
struct FogWaves {
  float x[kNumFogWaves], y[kNumFogWaves], z[kNumFogWaves];  ///< Turns per metre along the axes.
  float phase[kNumFogWaves];                                ///< Turns at the origin.
  float amplitude[kNumFogWaves];
};

/// A tile's beams and the waves of the fog in their frame.
struct FogBeams {
  const RayTile& rays;
  const DetectTile& tile;
  const FogWaves& waves;
};

/// The highest and the second highest peak of each beam's echo of fog.
struct FogPeaks {
  float range_m[2][kTileSize];
  /// Power, as the receiver measures it, over the least detectable; 0 where there is no such peak.
  float ratio[2][kTileSize];
};

struct ResponseParameters {
  bool is_lambert{};         ///< Effect surface_response is off.
  float inverse_power_m2{};  ///< 1 / P_min = R0^2 / 0.1.
  float snow_cover{};        ///< Snow-covered share of upward faces.
  float snow_a{}, snow_b{};  ///< The snow's diffuse_a and diffuse_b.
};

/// Where the echoes of a tile lie on surfaces with a texture, in cells of their own coordinates.
struct alignas(64) TextureLanes {
  float x[kTileSize], y[kTileSize], z[kTileSize];
  /// Added to the numbers of the cells: what of the coordinates is too large for float32.
  std::uint32_t base_x[kTileSize], base_y[kTileSize], base_z[kTileSize];
  std::uint32_t instance[kTileSize];  ///< The object's, so that objects of one kind differ.
  float variance[kTileSize];          ///< Relative variance of the response of a cell; 0 = none.
};

struct TextureParameters {
  std::uint64_t seed{};
  float sigma_h_rad{}, sigma_v_rad{};  ///< As BeamFrame.
};

/// Number of components of a wave that are summed at a time.
inline constexpr std::size_t kWaveLanes = 16;

/// The received waveform of one beam as a sum of Gaussians over range:
/// w(r) = sum_i peak_i exp(-(r - range_i)^2 / 2 variance_i).
struct EchoWave {
  std::size_t size{};  ///< A multiple of kWaveLanes; padding has peak 0.
  const float* range_m{};
  const float* peak{};                     ///< In multiples of the least detectable power.
  const float* inverse_variance_per_m2{};  ///< 1 / (pulse variance + spread variance).
};

/// A maximum of the waveform w(r).
struct WavePeak {
  float range_m{};
  float value{};
};

/// Number of climbs to maxima that go side by side.
inline constexpr std::size_t kClimbLanes = 8;

/// Climbs on waves, a lane each. Values of components are those of the first component of all
/// lanes, then those of the second, and so on; where a wave has fewer, peak is 0.
struct WaveClimbs {
  std::size_t num_components{};
  const float* range_m{};
  const float* peak{};
  const float* inverse_variance_per_m2{};
  float from_m[kClimbLanes]{};
};

}  // namespace railcast
