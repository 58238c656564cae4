#include "core/detect/kernels/kernels.h"

namespace railcast {

namespace baseline {
Kernels MakeKernels();
}
#ifdef RAILCAST_X86_KERNELS
namespace avx2 {
Kernels MakeKernels();
}
#endif

const std::vector<Kernels>& AvailableKernels() {
  static const std::vector<Kernels> kernels = [] {
    std::vector<Kernels> available{baseline::MakeKernels()};
#ifdef RAILCAST_X86_KERNELS
    if (__builtin_cpu_supports("avx2")) available.push_back(avx2::MakeKernels());
#endif
    return available;
  }();
  return kernels;
}

}  // namespace railcast
