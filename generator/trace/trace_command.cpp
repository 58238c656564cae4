#include <iostream>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/program/command_line.h"
#include "core/simulate/story_text.h"
#include "core/trace/trace_program.h"
#include "generator/commands.h"
#include "generator/run/stopping.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

struct TraceOptions {
  std::filesystem::path scenario;
  std::optional<std::string> sensor;  ///< Which sensor, if there are several.
  std::uint32_t frame = 0;
  std::uint32_t firing = 0;
  std::string isa;  ///< Instruction set of the trace; empty = the machine's best.
};

int RunTrace(const TraceOptions& options) {
  const ScenarioSpec scenario = PickSensor(ReadScenario(options.scenario), options.sensor);
  const std::string isa = AtPlace("--", [&] { return IsaInUse(options.isa); });
  const auto simulator = MakeSimulator(scenario, 1, isa);
  const std::size_t num_firings = simulator->pattern().num_firings();
  CheckHasStamp("--frame", simulator->pattern(), options.frame);
  if (options.firing >= num_firings) {
    throw InputError("--firing: must be < " + std::to_string(num_firings) +
                     ", the firings of a frame (got " + std::to_string(options.firing) + ")");
  }
  if (scenario.fidelity == Fidelity::kAuto) UseChosenFidelity(*simulator, scenario);
  const FiringStory story = simulator->Explain(options.frame, options.firing);
  std::cout << ShownLines(StoryText(options.frame, story, LabelTable(scenario.labels),
                                    MaterialLibrary(scenario.materials)));
  return kExitSuccess;
}

}  // namespace

void AddTrace(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<TraceOptions>();
  ProgramOptions trace =
      app.AddCommand("trace", "Replay one firing and print what each effect makes of it");
  trace.AddOption("SCENARIO", options->scenario, "Scenario file").Required().Check(NonEmpty());
  trace.AddOption("--sensor", options->sensor,
                  "Name of the sensor to trace, where the scenario has several");
  trace.AddOption("--frame", options->frame, "Number of the frame, from 0")
      .Check(Whole({0, kMaxFrame}))
      .ShowDefault();
  trace
      .AddOption("--firing", options->firing,
                 "Number of the firing in its frame, from 0, in order of time")
      .Required()
      .Check(Whole({0, kMaxFrame}));
  AddIsa(trace, options->isa);
  trace.WhenParsed([&command, options] {
    command = [options](const std::string&) { return RunTrace(*options); };
  });
}

}  // namespace railcast
