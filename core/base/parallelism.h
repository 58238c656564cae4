#pragma once

#include <memory>

namespace railcast {

/// Holds a number of threads while it or a copy of it lives. What it holds is TBB's, whose headers
/// take longer to compile than most sources.
using HeldThreads = std::shared_ptr<const void>;

/// Lets arenas have so many threads while the result lives, also more than there are cores: TBB
/// starts none of those by itself, and warns. 0 = one for each core.
///
///     const auto allowed = AllowThreads(8);
///     tbb::task_arena arena(8);
[[nodiscard]] HeldThreads AllowThreads(int num_threads);

/// Limits the number of threads to that of --threads while the result lives; 0 = all cores.
///
///     const auto limit = LimitThreads(options.num_threads);
[[nodiscard]] HeldThreads LimitThreads(int num_threads);

}  // namespace railcast
