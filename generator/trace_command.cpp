#include <iostream>
#include <string>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/shown_text.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario.h"
#include "core/simulate/story_text.h"
#include "core/trace/trace_program.h"
#include "generator/chosen_fidelity.h"
#include "generator/commands.h"
#include "generator/frame_limits.h"

namespace railcast {

int TraceCommand(const TraceOptions& options) {
  const ScenarioSpec scenario = PickSensor(ReadScenario(options.scenario), options.sensor);
  const std::string isa = AtPlace("--", [&] { return IsaInUse(options.isa); });
  const auto simulator = MakeSimulator(scenario, 1, isa);
  const std::size_t num_firings = simulator->pattern().num_firings();
  CheckHasStamp("--frame", simulator->pattern(), options.frame);
  if (options.firing >= num_firings) {
    throw InputError("--firing: must be < " + std::to_string(num_firings) +
                     ", the firings of a frame (got " + std::to_string(options.firing) + ")");
  }
  if (scenario.fidelity == kAutoFidelity) UseChosenFidelity(*simulator, scenario);
  const FiringStory story = simulator->Explain(options.frame, options.firing);
  std::cout << ShownLines(StoryText(options.frame, story, LabelTable(scenario.labels),
                                    MaterialLibrary(scenario.materials)));
  return kExitSuccess;
}

}  // namespace railcast
