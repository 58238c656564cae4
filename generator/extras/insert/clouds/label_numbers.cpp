#include "generator/extras/insert/clouds/label_numbers.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/kitti.h"

namespace railcast {

LabelNumbers::LabelNumbers(const LabelTable& plan,
                           const RecordingInfo& info,
                           const std::vector<std::string>& needed)
    : has_kitti_labels_(info.has_kitti_labels) {
  for (const Label& label : plan.labels()) {
    const Label* const theirs = info.labels.Find(label.name);
    const bool is_needed = std::ranges::find(needed, label.name) != needed.end();
    if (has_kitti_labels_) {
      numbers_[label.id] = label.semantic_kitti;
    } else if (theirs != nullptr || info.labels.labels().empty()) {
      numbers_[label.id] = theirs == nullptr ? label.id : theirs->id;
    } else if (is_needed) {
      throw InputError("--format same: the recording's label table must have the plan's label " +
                       Quoted(label.name));
    }
  }
}

LabelNumbers LabelNumbersOf(const InsertPlan& plan, const RecordingInfo& info) {
  const LabelTable table(plan.scenario.labels);
  std::vector<std::string> needed;
  for (const SceneObject& object : plan.world->objects()) {
    if (const Label* const label = table.Find(object.label)) needed.push_back(label->name);
  }
  return {table, info, needed};
}

std::set<std::uint32_t> MovingInstances(const std::vector<RecordedObject>& objects) {
  std::set<std::uint32_t> moving;
  for (const RecordedObject& object : objects) {
    if (IsMoving(object.velocity_world_mps)) moving.insert(object.instance);
  }
  return moving;
}

std::vector<std::uint32_t> WrittenLabels(const InsertedFrame& inserted,
                                         const LabelNumbers& labels) {
  const Frame& frame = inserted.recorded.frame;
  const std::set<std::uint32_t> moving = MovingInstances(inserted.objects);
  std::vector<std::uint32_t> written = frame.label;
  for (const SlotEdit& edit : inserted.edits) {
    if (!edit.is_added || edit.is_merged) continue;
    written[edit.slot] =
        labels.Of(frame.label[edit.slot], moving.contains(frame.instance[edit.slot]));
  }
  return written;
}

std::uint32_t LabelNumbers::Of(std::uint32_t plan_id, bool moves) const {
  const auto found = numbers_.find(plan_id);
  const std::uint32_t number = found == numbers_.end() ? 0 : found->second;
  const bool is_moving = moves && has_kitti_labels_;
  return is_moving ? MovingSemanticKitti(static_cast<std::uint16_t>(number)) : number;
}

}  // namespace railcast
