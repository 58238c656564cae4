// This file is compiled once per instruction set (see CMakeLists.txt); RAILCAST_ISA names the copy.
// The function below must be the only one with external linkage, or the linker could replace one
// copy's code by that of another instruction set.
#include "core/detect/kernels/kernels.h"
#include "core/detect/kernels/echo_power.h"
#include "core/detect/kernels/fog_echo.h"
#include "core/detect/kernels/measurement.h"
#include "core/detect/kernels/published.h"
#include "core/detect/kernels/rays.h"
#include "core/detect/kernels/surface_response.h"
#include "core/detect/kernels/waveform.h"

namespace railcast::RAILCAST_ISA {

Kernels MakeKernels();

#define RAILCAST_KERNEL_POINTER(name, function, type) .name = &(function),
Kernels MakeKernels() {
  return {.isa = RAILCAST_ISA_NAME, RAILCAST_KERNELS(RAILCAST_KERNEL_POINTER)};
}
#undef RAILCAST_KERNEL_POINTER

}  // namespace railcast::RAILCAST_ISA
