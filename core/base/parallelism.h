#pragma once

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <cstddef>
#include <memory>

namespace railcast {

/// Lets arenas have so many threads while the result lives, also more than there are cores: TBB
/// starts none of those by itself, and warns. 0 = one for each core.
///
///     const auto allowed = AllowThreads(8);
///     tbb::task_arena arena(8);
[[nodiscard]] inline std::unique_ptr<tbb::global_control> AllowThreads(int num_threads) {
  return std::make_unique<tbb::global_control>(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(std::max(num_threads, tbb::info::default_concurrency())));
}

}  // namespace railcast
