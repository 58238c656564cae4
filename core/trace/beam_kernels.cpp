// This file is compiled once per instruction set (see CMakeLists.txt); RAILCAST_ISA names the copy.
// The function below must be the only one with external linkage, or the linker could replace one
// copy's code by that of another instruction set.
#include "core/trace/beam_kernels.h"

#include "core/trace/trace_beam.h"

namespace railcast::RAILCAST_ISA {

BeamKernel MakeBeamKernel();

BeamKernel MakeBeamKernel() {
  return {.isa = RAILCAST_ISA_NAME, .trace = &TraceBeam, .may_meet = &MayMeetBeam};
}

}  // namespace railcast::RAILCAST_ISA
