#pragma once

#include <string_view>
#include <vector>

#include "core/trace/beam_tree.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// The trace of beams (trace_beam.h), compiled for one instruction set. All give the same bits.
struct BeamKernel {
  std::string_view isa;
  void (*trace)(const BeamScene& scene, BeamRays& beam);
  /// MayMeet() (trace_scene.h) of one scene, whatever the mask.
  bool (*may_meet)(const BeamScene& scene, const BeamRays& beam);
};

/// The kernels that this machine can run, the fastest last.
[[nodiscard]] const std::vector<BeamKernel>& AvailableBeamKernels();

}  // namespace railcast
