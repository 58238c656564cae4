#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/effect_parameters.h"

namespace railcast {

/// The list of all kernels: name of the member in Kernels, function in the namespace of each
/// instruction set, and type. kernels.cpp includes the headers that define the functions.
#define RAILCAST_KERNELS(KERNEL)                                                                 \
  /* One uniform number in [0, 1) for the firing of each lane. */                                \
  KERNEL(uniforms, DrawUniforms, void(const DetectTile&, const DrawKey&, float*))                \
  KERNEL(pointing, ApplyPointing,                                                                \
         void(RayTile&, const DetectTile&, const BeamFrame&, const PointingParameters&))         \
  /* The random turns of the firings' patterns. Both effects of beams share them. */             \
  KERNEL(pattern_turns, DrawPatternTurns,                                                        \
         void(const DetectTile&, std::uint64_t seed, PatternTurns&))                             \
  KERNEL(aim_sub_rays, AimSubRays,                                                               \
         void(const RayTile&, std::size_t lane, const BeamFrame&, const SubRayAim&, BeamRays&))  \
  KERNEL(incidence, ApplyIncidence, void(const RayTile&, DetectTile&))                           \
  KERNEL(spread, ApplySpread, void(const RayTile&, const BeamFrame&, DetectTile&))               \
  KERNEL(hit, ApplyHit, void(DetectTile&, float range_min_m))                                    \
  KERNEL(sensor_dropout, ApplySensorDropout,                                                     \
         void(DetectTile&, const struct SensorDropoutParameters&))                               \
  /* The published model. */                                                                     \
  KERNEL(threshold, ApplyThreshold, void(DetectTile&, const struct ThresholdParameters&))        \
  KERNEL(rain, ApplyRainDropout, void(DetectTile&, const struct RainParameters&))                \
  KERNEL(snow, ApplySnowClutter, void(DetectTile&, const struct SnowParameters&))                \
  /* Physics. */                                                                                 \
  KERNEL(response, ApplyResponse, void(DetectTile&, const ResponseParameters&))                  \
  KERNEL(pulse_stretch, ApplyPulseStretch,                                                       \
         void(DetectTile&, const struct PulseStretchParameters&))                                \
  KERNEL(texture, ApplyTexture,                                                                  \
         void(DetectTile&, const TextureLanes&, const struct TextureParameters&))                \
  KERNEL(extinction, ApplyExtinction, void(DetectTile&, float extinction_per_m))                 \
  KERNEL(sunlight, ApplySunlight, void(DetectTile&, const struct SunlightParameters&))           \
  KERNEL(cover_loss, ApplyCoverLoss, void(DetectTile&))                                          \
  KERNEL(blame_cover, BlameCover, void(DetectTile&))                                             \
  KERNEL(range_walk, ApplyRangeWalk, void(DetectTile&, float range_walk_m))                      \
  KERNEL(saturation, ApplySaturation, void(DetectTile&, const struct SaturationParameters&))     \
  KERNEL(detection, ApplyDetection<false>, void(DetectTile&, const struct DetectionParameters&)) \
  KERNEL(smooth_detection, ApplyDetection<true>,                                                 \
         void(DetectTile&, const struct DetectionParameters&))                                   \
  KERNEL(fog_peaks, FindFogPeaks,                                                                \
         void(const FogBeams&, const struct FogEchoParameters&, FogPeaks&))                      \
  KERNEL(climb_waves, ClimbWaves, void(const WaveClimbs&, WavePeak*))                            \
  KERNEL(sample_wave, SampleWave,                                                                \
         void(const EchoWave&, float first_m, float step_m, std::size_t num, float* samples))    \
  KERNEL(intensity_noise, ScaleIntensity<IntensityErrors::kOfEcho>,                              \
         void(DetectTile&, const struct IntensityErrorParameters&))                              \
  KERNEL(channel_gain, ScaleIntensity<IntensityErrors::kOfChannel>,                              \
         void(DetectTile&, const struct IntensityErrorParameters&))                              \
  KERNEL(channel_gain_variation, ScaleIntensity<IntensityErrors::kOfChannelByRange>,             \
         void(DetectTile&, const struct IntensityErrorParameters&))                              \
  KERNEL(measure_exact, ApplyMeasurement<RangeErrors::kNone>,                                    \
         void(DetectTile&, const struct MeasurementParameters&))                                 \
  KERNEL(measure_isotropic, ApplyMeasurement<RangeErrors::kIsotropic>,                           \
         void(DetectTile&, const struct MeasurementParameters&))                                 \
  KERNEL(measure_along_beam, ApplyMeasurement<RangeErrors::kBeam>,                               \
         void(DetectTile&, const struct MeasurementParameters&))                                 \
  KERNEL(measure_by_signal, ApplyMeasurement<RangeErrors::kSignal>,                              \
         void(DetectTile&, const struct MeasurementParameters&))

/// The effects' loops compiled for one instruction set. All instruction sets give the same bits.
struct Kernels {
  std::string_view isa;
#define RAILCAST_KERNEL_MEMBER(name, function, type) std::add_pointer_t<type> name;
  RAILCAST_KERNELS(RAILCAST_KERNEL_MEMBER)
#undef RAILCAST_KERNEL_MEMBER
};

/// The kernels that this machine can run, the fastest last.
[[nodiscard]] const std::vector<Kernels>& AvailableKernels();

}  // namespace railcast
