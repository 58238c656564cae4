#include "generator/dataset/run_dataset.h"

#include <chrono>
#include <memory>
#include <utility>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/dataset_files.h"
#include "core/io/scenario_identity.h"
#include "core/io/sequence_files.h"
#include "core/io/write_file.h"
#include "core/program/version.h"
#include "core/trace/trace_program.h"
#include "generator/dataset/dataset_files.h"
#include "generator/run/commanded_run.h"
#include "generator/run/stoppable_work.h"
#include "generator/sequence/make_sequences.h"
#include "generator/sequence/scenario_sequence.h"
#include "railcast/simulator.h"

namespace railcast {
namespace {

DatasetSpec SpecOfDataset(const Recipe& recipe,
                          const DatasetChoices& choices,
                          const RecipeBases& bases) {
  DatasetSpec spec{.directory = choices.directory,
                   .version = ProgramVersion(),
                   .embree_version = EmbreeVersion(),
                   .isa = AtPlace("--", [&] { return IsaInUse(choices.isa); }),
                   .recipe = ReadFileWhole(recipe.file),
                   .base_hashes = {},
                   .num_scenarios = recipe.num_scenarios,
                   .format = choices.format,
                   .fields = choices.fields,
                   .shard = choices.shard};
  for (std::size_t i = 0; i < recipe.bases.size(); ++i) spec.base_hashes.push_back(bases.hash(i));
  return spec;
}

SequenceChoices ChoicesOfScenario(const Recipe& recipe,
                                  const DatasetChoices& choices,
                                  std::uint32_t scenario) {
  return {.directory = choices.directory / SequenceFolderOf(scenario),
          .format = choices.format,
          .fields = choices.fields,
          .isa = choices.isa,
          .start_frame = recipe.warm_up_frames,
          .num_frames = recipe.num_frames,
          .stride = recipe.stride};
}

/// Makes the sequences of a shard.
class DatasetRun {
 public:
  DatasetRun(const Recipe& recipe, const DatasetChoices& choices, const DatasetHooks& hooks)
      : recipe_(recipe),
        choices_(choices),
        hooks_(hooks),
        drawer_(recipe),
        directory_(SpecOfDataset(recipe, choices, drawer_.bases())) {}

  DatasetResult Run() {
    const auto begin = std::chrono::steady_clock::now();
    result_.num_scenarios = choices_.shard.NumOf(recipe_.num_scenarios);
    result_.num_resumed = directory_.num_done();
    result_.was_complete = directory_.is_complete();
    bool goes_on = !result_.was_complete;
    while (goes_on && directory_.num_done() < result_.num_scenarios) {
      hooks_.on_progress(directory_.num_done(), result_.num_scenarios);
      goes_on = !hooks_.is_stopped() && MakeNext();
    }
    result_.num_done = directory_.num_done();
    const bool has_all = result_.num_done == result_.num_scenarios;
    if (has_all && !result_.was_complete) {
      directory_.Sync();
      if (choices_.shard.is_whole()) WriteDatasetFiles(directory_.spec());
    }
    result_.is_complete = has_all;
    result_.elapsed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result_;
  }

 private:
  // Returns whether the next scenario is done; not if the run was stopped.
  bool MakeNext() {
    const std::uint32_t number = choices_.shard.ScenarioAt(directory_.num_done());
    DrawnScenario drawn = drawer_.Draw(number);
    CheckOutputSuits(choices_.format, drawn.scenario,
                     ShownPath(recipe_.file) + ": scenario " + std::to_string(number));
    SequenceSpec spec =
        SequenceSpecOf(drawn.scenario, ChoicesOfScenario(recipe_, choices_, number));
    SensorRun sensor = {drawn.scenario.lidar.name, std::move(drawn.scenario), std::move(spec)};
    const SequenceResult made = MakeSequence(sensor);
    result_.num_frames += made.num_done - made.num_resumed;
    if (!made.is_complete) return false;
    Json& record = drawn.record;
    const std::string manifest = ReadFileWhole(sensor.spec.directory / kManifestFile);
    record["folder"] = SequenceFolderOf(number);
    record["num_frames"] = made.num_done;
    record["points"] = made.counts.points;
    record["scenario_xxh3"] = sensor.spec.identity.scenario_hash;
    record["data_xxh3"] = Json::parse(manifest).at("data_xxh3");
    record["manifest_xxh3"] = ContentHash(manifest);
    directory_.Append(record);
    return true;
  }

  [[nodiscard]] SequenceResult MakeSequence(SensorRun& sensor) {
    const auto simulators = MakeSimulators(sensor.scenario, choices_.num_threads, sensor.spec.isa);
    Simulator& simulator = *simulators.front();
    CheckSameFiles(sensor.scenario, sensor.spec.identity);
    WatchBuilding(simulator, hooks_.is_stopped, true);
    if (sensor.scenario.fidelity == Fidelity::kAuto) {
      try {
        static_cast<void>(ChooseFidelity(simulator, sensor));
      } catch (const RunStopped&) {
        return {};
      }
    }
    CommandedRun run(sensor.scenario, {&simulator});
    const SequenceHooks hooks = {[](std::uint32_t, std::uint32_t) {}, hooks_.is_stopped};
    return MakeSequences(run, simulators, {&sensor, 1}, false, hooks).front();
  }

  const Recipe& recipe_;
  const DatasetChoices& choices_;
  const DatasetHooks& hooks_;
  ScenarioDrawer drawer_;
  DatasetDirectory directory_;
  DatasetResult result_;
};

}  // namespace

DatasetResult RunDataset(const Recipe& recipe,
                         const DatasetChoices& choices,
                         const DatasetHooks& hooks) {
  return DatasetRun(recipe, choices, hooks).Run();
}

}  // namespace railcast
