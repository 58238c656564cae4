#pragma once

#include <cstdint>
#include <memory>

#include "generator/extras/insert/insert_plan.h"
#include "generator/extras/insert/inserted_frame.h"
#include "generator/extras/insert/recorded_firings.h"

namespace railcast {

/// Puts the objects and the weather of a plan into recorded frames.
class Inserter {
 public:
  /// @param num_threads 0 = all cores.
  /// @throws InputError if the plan cannot be simulated.
  Inserter(const InsertPlan& plan, int num_threads);
  ~Inserter();

  /// The result depends on the plan, the frame and its index alone. One caller at a time.
  /// @param frame_index Counted from 0 in the recording.
  [[nodiscard]] InsertedFrame Insert(const RecordedFirings& firings, std::uint32_t frame_index);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace railcast
