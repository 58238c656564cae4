#include "core/base/parallelism.h"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <cstddef>
#include <thread>

namespace railcast {
namespace {

HeldThreads HoldThreads(std::size_t num_threads) {
  return std::make_shared<const tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                     num_threads);
}

}  // namespace

HeldThreads AllowThreads(int num_threads) {
  return HoldThreads(
      static_cast<std::size_t>(std::max(num_threads, tbb::info::default_concurrency())));
}

HeldThreads LimitThreads(int num_threads) {
  return HoldThreads(num_threads > 0 ? static_cast<std::size_t>(num_threads)
                                     : std::size_t{std::thread::hardware_concurrency()});
}

}  // namespace railcast
