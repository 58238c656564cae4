// Compiled once per instruction set, see CMakeLists.txt: RAILCAST_ISA names the copy. Nothing with
// external linkage may be instantiated here besides the one function below.
#include "core/detect/kernels.h"
#include "core/detect/detection.h"
#include "core/detect/extinction.h"
#include "core/detect/incidence.h"
#include "core/detect/measurement.h"
#include "core/detect/pointing.h"
#include "core/detect/rain_dropout.h"
#include "core/detect/sensor_dropout.h"
#include "core/detect/snow_clutter.h"
#include "core/detect/surface_response.h"
#include "core/detect/threshold.h"
#include "core/detect/waveform.h"

#define RAILCAST_STRINGIFY_(name) #name
#define RAILCAST_STRINGIFY(name) RAILCAST_STRINGIFY_(name)

namespace railcast::RAILCAST_ISA {

Kernels MakeKernels();

Kernels MakeKernels() {
  return {.isa = RAILCAST_STRINGIFY(RAILCAST_ISA),
          .uniforms = &DrawUniforms,
          .pointing = &ApplyPointing,
          .incidence = &ApplyIncidence,
          .spread = &ApplySpread,
          .hit = &ApplyHit,
          .sensor_dropout = &ApplySensorDropout,
          .threshold = &ApplyThreshold,
          .rain = &ApplyRainDropout,
          .snow = &ApplySnowClutter,
          .response = &ApplyResponse,
          .pulse_stretch = &ApplyPulseStretch,
          .extinction = &ApplyExtinction,
          .sunlight = &ApplySunlight,
          .detection = &ApplyDetection<false>,
          .smooth_detection = &ApplyDetection<true>,
          .climb_wave = &ClimbWave,
          .sample_wave = &SampleWave,
          .measure_exact = &ApplyMeasurement<NoiseShape::kNone>,
          .measure_isotropic = &ApplyMeasurement<NoiseShape::kIsotropic>,
          .measure_along_beam = &ApplyMeasurement<NoiseShape::kBeam>,
          .measure_by_signal = &ApplyMeasurement<NoiseShape::kSignal>};
}

}  // namespace railcast::RAILCAST_ISA
