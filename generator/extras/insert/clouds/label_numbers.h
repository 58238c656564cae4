#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "generator/extras/insert/insert_plan.h"
#include "generator/extras/insert/inserted_frame.h"
#include "railcast/io/recording.h"

namespace railcast {

/// The numbers that a recording gives to the labels of a plan.
class LabelNumbers {
 public:
  /// @param plan The plan's table, whose ids inserted frames have.
  /// @throws InputError "--format same: label "x" of the plan must be in the recording's label
  ///   table" if it is not.
  LabelNumbers(const LabelTable& plan,
               const RecordingInfo& info,
               const std::vector<std::string>& needed);

  /// @param moves Whether it is of an object that moves, for which KITTI has other numbers.
  [[nodiscard]] std::uint32_t Of(std::uint32_t plan_id, bool moves) const;

 private:
  bool has_kitti_labels_;
  std::map<std::uint32_t, std::uint32_t> numbers_;
};

/// The instances of those that move of a frame's objects.
[[nodiscard]] std::set<std::uint32_t> MovingInstances(const std::vector<RecordedObject>& objects);

/// The label of each slot as it is written: of what was put in by `labels`, else as recorded.
[[nodiscard]] std::vector<std::uint32_t> WrittenLabels(const InsertedFrame& inserted,
                                                       const LabelNumbers& labels);

/// The numbers for the labels of the plan's objects.
/// @throws InputError as LabelNumbers() does.
[[nodiscard]] LabelNumbers LabelNumbersOf(const InsertPlan& plan, const RecordingInfo& info);

}  // namespace railcast
