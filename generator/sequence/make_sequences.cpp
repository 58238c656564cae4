#include "generator/sequence/make_sequences.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>

#include "generator/run/stopping.h"
#include "generator/sequence/surveyed_run.h"

namespace railcast {

FidelityChoice ChooseFidelity(Simulator& simulator, SensorRun& sensor) {
  FidelityChoice choice = UseChosenFidelity(simulator, sensor.scenario);
  sensor.spec.fidelity_choice_json = ChoiceJson(choice, sensor.scenario.tolerance);
  return choice;
}

std::vector<SequenceResult> MakeSequences(CommandedRun& run,
                                          const std::vector<std::unique_ptr<Simulator>>& simulators,
                                          std::span<const SensorRun> sensors,
                                          bool has_commands,
                                          const SequenceHooks& hooks) {
  std::deque<SurveyedRun> surveys;
  std::vector<SensorSequence> sequences;
  // Commands change the simulators from one frame to the next.
  std::size_t num_at_once = has_commands ? 1 : std::numeric_limits<std::size_t>::max();
  for (std::size_t i = 0; i < simulators.size(); ++i) {
    const auto& [name, scenario, spec] = sensors[i];
    const ScanPattern& pattern = simulators[i]->pattern();
    simulators[i]->UseLastStamp(pattern.StampNs(spec.FrameAt(spec.num_frames - 1)));
    SurveyedRun& survey = surveys.emplace_back(run, i, scenario, spec.files.labels);
    sequences.push_back({spec, [&survey](std::uint32_t index) { return survey.Begin(index); },
                         [&pattern](std::uint32_t index) { return pattern.StampNs(index); }});
    num_at_once = std::min(num_at_once, NumFramesAtOnce(*simulators[i], scenario));
  }
  const FramesAtOnce at_once = {
      num_at_once, [&](const std::function<void()>& work) { simulators.front()->Execute(work); }};
  return RunSequences(sequences, hooks, at_once);
}

}  // namespace railcast
