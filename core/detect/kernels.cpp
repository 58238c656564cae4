// Compiled once per instruction set, see CMakeLists.txt: RAILCAST_ISA names the copy. Nothing with
// external linkage may be instantiated here besides the one function below.
#include "core/detect/kernels.h"
#include "core/detect/measurement.h"
#include "core/detect/rain_dropout.h"
#include "core/detect/sensor_dropout.h"
#include "core/detect/snow_clutter.h"
#include "core/detect/threshold.h"

#define RAILCAST_STRINGIFY_(name) #name
#define RAILCAST_STRINGIFY(name) RAILCAST_STRINGIFY_(name)

namespace railcast::RAILCAST_ISA {

Kernels MakeKernels();

Kernels MakeKernels() {
  return {.isa = RAILCAST_STRINGIFY(RAILCAST_ISA),
          .hit = &ApplyHit,
          .threshold = &ApplyThreshold,
          .rain = &ApplyRainDropout,
          .snow = &ApplySnowClutter,
          .sensor_dropout = &ApplySensorDropout,
          .measure_exact = &ApplyMeasurement<NoiseShape::kNone>,
          .measure_isotropic = &ApplyMeasurement<NoiseShape::kIsotropic>,
          .measure_along_beam = &ApplyMeasurement<NoiseShape::kBeam>};
}

}  // namespace railcast::RAILCAST_ISA
