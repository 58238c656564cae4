#pragma once

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <string>

#include "core/base/out_of_memory.h"

namespace railcast {

/// Throws if the calling thread's last use of Embree failed. Embree does not throw but records the
/// first error of each thread. If it were not queried, a scene that did not fit into memory would
/// let all rays pass through.
/// @param device Null: asks why no device could be made.
/// @param doing Words after "while", as for WithinMemory().
/// @throws InputError if memory ran out.
void ThrowIfEmbreeFailed(RTCDevice device, const std::string& doing);

/// Runs `build`, which uses Embree, with a single thread: the order of primitives in the leaves
/// decides what a ray on an edge hits, and that order must not depend on how the work was shared.
/// @param doing As for WithinMemory().
/// @throws InputError if memory runs out.
template <typename Doing, typename Build>
void BuildWithEmbree(RTCDevice device, const Doing& doing, const Build& build) {
  // Clear an error left by an earlier failed build.
  static_cast<void>(rtcGetDeviceError(device));
  WithinMemory(doing, [&] {
    tbb::task_arena one_thread(1);
    one_thread.execute(build);
  });
  ThrowIfEmbreeFailed(device, doing());
}

}  // namespace railcast
