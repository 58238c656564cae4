#include "viewer/frames/frames.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/kitti.h"
#include "core/io/run/scenario_identity.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "viewer/frames/world_objects.h"

namespace railcast {

void Frames::UseScenario(const ScenarioSpec& scenario) {
  if (info_.scenario) {
    if (IdentityOf(*info_.scenario) == IdentityOf(scenario)) return;
    throw InputError(ShownPath(info_.source) +
                     ": has a scenario of its own: --scenario must be the same or be left out");
  }
  world_ = MakeWorld(scenario);
  info_.scenario = scenario;
  info_.labels = LabelTable(scenario.labels);
  if (info_.has_kitti_labels) info_.labels = SemanticKittiLabels(info_.labels);
  info_.materials.clear();
  const MaterialLibrary library(scenario.materials);
  for (const Material& material : library.materials()) info_.materials.push_back(material.name);
}

std::shared_ptr<const ShownFrame> Frames::Shown(RecordedFrame recorded) const {
  if (world_ && recorded.has_pose && recorded.objects.empty()) {
    recorded.objects = ObjectsAt(*world_, LabelTable(info_.scenario->labels), recorded.frame);
  }
  return std::make_shared<const ShownFrame>(MakeShownFrame(std::move(recorded)));
}

}  // namespace railcast
