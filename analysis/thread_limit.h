#pragma once

#include <tbb/global_control.h>

#include <cstddef>
#include <thread>

namespace railcast {

/// Limits the number of threads to that of --threads during the lifetime of the result; 0 = all
/// cores.
[[nodiscard]] inline tbb::global_control LimitThreads(int num_threads) {
  const std::size_t most = num_threads > 0 ? static_cast<std::size_t>(num_threads)
                                           : std::size_t{std::thread::hardware_concurrency()};
  return {tbb::global_control::max_allowed_parallelism, most};
}

}  // namespace railcast
