#pragma once

#include <sys/resource.h>

#include <cstddef>
#include <fstream>

namespace railcast {

/// Whether the address space can be limited in this build: the sanitizers reserve terabytes of it.
inline constexpr bool kCanLimitMemory =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    false;
#else
    true;
#endif

/// Limits this process to `more_bytes` of memory beyond what it has. For death tests.
inline void LimitMemory(std::size_t more_bytes) {
  std::size_t num_pages = 0;
  std::ifstream("/proc/self/statm") >> num_pages;
  constexpr std::size_t kPage_bytes = 4096;
  const rlim_t most = num_pages * kPage_bytes + more_bytes;
  const rlimit limit{most, most};
  ::setrlimit(RLIMIT_AS, &limit);
}

}  // namespace railcast
