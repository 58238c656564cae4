#pragma once

#include <string_view>
#include <vector>

#include "core/detect/detect_tile.h"
#include "core/detect/echo_wave.h"
#include "core/detect/effect_parameters.h"

namespace railcast {

/// The effects' loops, compiled for one instruction set. Every set gives the same bits.
struct Kernels {
  std::string_view isa;
  /// One uniform number in [0, 1) for each lane's firing.
  void (*uniforms)(const DetectTile&, const DrawKey&, float*);
  void (*pointing)(RayTile&, const DetectTile&, const BeamFrame&, const PointingParameters&);
  void (*incidence)(const RayTile&, DetectTile&);
  void (*spread)(const RayTile&, const BeamFrame&, DetectTile&);
  void (*hit)(DetectTile&, float range_min_m);
  void (*sensor_dropout)(DetectTile&, const SensorDropoutParameters&);
  // The published model.
  void (*threshold)(DetectTile&, const ThresholdParameters&);
  void (*rain)(DetectTile&, const RainParameters&);
  void (*snow)(DetectTile&, const SnowParameters&);
  // Physics.
  void (*response)(DetectTile&, const ResponseParameters&);
  void (*pulse_stretch)(DetectTile&, float pulse_sigma_m);
  void (*extinction)(DetectTile&, float extinction_per_m);
  void (*sunlight)(DetectTile&, const SunlightParameters&);
  void (*detection)(DetectTile&, const DetectionParameters&);
  void (*smooth_detection)(DetectTile&, const DetectionParameters&);

  WavePeak (*climb_wave)(const EchoWave&, float from_m, const WaveKnown&);
  void (*sample_wave)(
      const EchoWave&, float first_m, float step_m, std::size_t num_samples, float* samples);

  void (*measure_exact)(DetectTile&, const MeasurementParameters&);
  void (*measure_isotropic)(DetectTile&, const MeasurementParameters&);
  void (*measure_along_beam)(DetectTile&, const MeasurementParameters&);
  void (*measure_by_signal)(DetectTile&, const MeasurementParameters&);
};

/// The kernels that this machine can run, the fastest last.
[[nodiscard]] const std::vector<Kernels>& AvailableKernels();

}  // namespace railcast
