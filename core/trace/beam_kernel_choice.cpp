#include "core/trace/beam_kernels.h"

namespace railcast {

namespace baseline {
BeamKernel MakeBeamKernel();
}
#ifdef RAILCAST_X86_KERNELS
namespace avx2 {
BeamKernel MakeBeamKernel();
}
#endif

const std::vector<BeamKernel>& AvailableBeamKernels() {
  static const std::vector<BeamKernel> kernels = [] {
    std::vector<BeamKernel> available{baseline::MakeBeamKernel()};
#ifdef RAILCAST_X86_KERNELS
    if (__builtin_cpu_supports("avx2")) available.push_back(avx2::MakeBeamKernel());
#endif
    return available;
  }();
  return kernels;
}

}  // namespace railcast
