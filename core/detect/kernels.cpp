// This file is compiled once per instruction set (see CMakeLists.txt); RAILCAST_ISA names the copy.
// The function below must be the only one with external linkage, or the linker could replace one
// copy's code by that of another instruction set.
#include "core/detect/kernels.h"
#include "core/detect/cover_loss.h"
#include "core/detect/detection.h"
#include "core/detect/extinction.h"
#include "core/detect/fog_echo.h"
#include "core/detect/incidence.h"
#include "core/detect/measurement.h"
#include "core/detect/pointing.h"
#include "core/detect/rain_dropout.h"
#include "core/detect/range_walk.h"
#include "core/detect/saturation.h"
#include "core/detect/sensor_dropout.h"
#include "core/detect/snow_clutter.h"
#include "core/detect/sub_ray_aim.h"
#include "core/detect/surface_response.h"
#include "core/detect/threshold.h"
#include "core/detect/waveform.h"

namespace railcast::RAILCAST_ISA {

Kernels MakeKernels();

#define RAILCAST_KERNEL_POINTER(name, function, type) .name = &function,
Kernels MakeKernels() {
  return {.isa = RAILCAST_ISA_NAME, RAILCAST_KERNELS(RAILCAST_KERNEL_POINTER)};
}
#undef RAILCAST_KERNEL_POINTER

}  // namespace railcast::RAILCAST_ISA
