#pragma once

#include <string_view>
#include <vector>

#include "core/detect/detect_tile.h"
#include "core/detect/effect_parameters.h"

namespace railcast {

/// The effects' loops, compiled for one instruction set. Every set gives the same bits.
struct Kernels {
  std::string_view isa;
  void (*hit)(DetectTile&, float range_min_m);
  void (*threshold)(DetectTile&, const ThresholdParameters&);
  void (*rain)(DetectTile&, const RainParameters&);
  void (*snow)(DetectTile&, const SnowParameters&);
  void (*sensor_dropout)(DetectTile&, const SensorDropoutParameters&);
  void (*measure_exact)(DetectTile&, const MeasurementParameters&);
  void (*measure_isotropic)(DetectTile&, const MeasurementParameters&);
  void (*measure_along_beam)(DetectTile&, const MeasurementParameters&);
};

/// The kernels that this machine can run, the fastest last.
[[nodiscard]] const std::vector<Kernels>& AvailableKernels();

}  // namespace railcast
