#include "generator/extras/dataset/run_dataset.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/certify/certifier.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/extras/recipe/recipe_files.h"
#include "core/extras/recipe/scenario_turns.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "core/program/version.h"
#include "core/scenario/shared_scenery.h"
#include "core/trace/trace_program.h"
#include "generator/extras/dataset/dataset_directory.h"
#include "generator/extras/dataset/inserted_scenarios.h"
#include "generator/extras/insert/inserter.h"
#include "generator/extras/insert/run/insert_run.h"
#include "generator/run/all_sensors.h"
#include "generator/run/frame_maker.h"
#include "generator/run/make_frames.h"
#include "generator/run/run_directory.h"
#include "generator/run/run_plan.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

DatasetSpec SpecOfDataset(const Recipe& recipe,
                          const DatasetChoices& choices,
                          const RecipeBases& bases) {
  DatasetSpec spec{.directory = choices.directory,
                   .recipe = ReadFileWhole(recipe.file),
                   .record = {.version = ProgramVersion(),
                              .embree = EmbreeVersion(),
                              .isa = AtPlace("--", [&] { return IsaInUse(choices.isa); }),
                              .recipe_hash = {},
                              .num_scenarios = recipe.num_scenarios,
                              .format = choices.format,
                              .fields = choices.fields,
                              .is_merged = choices.is_merged,
                              .files_hash = HashOfRecipeFiles(recipe),
                              .certify = CertifiedShareOf(choices.certify)},
                   .shard = choices.shard};
  spec.record.recipe_hash = ContentHash(spec.recipe);
  for (std::size_t i = 0; i < recipe.bases.size(); ++i) {
    spec.record.base_hashes.push_back(bases.hash(i));
  }
  return spec;
}

RunChoices ChoicesOfScenario(const Recipe& recipe,
                             const DatasetChoices& choices,
                             std::uint32_t scenario) {
  RunChoices made = choices;
  made.directory /= SequenceFolderOf(scenario);
  made.start_frame = recipe.warm_up_frames;
  made.num_frames = recipe.num_frames;
  made.stride = recipe.stride;
  return made;
}

std::string PlaceOf(const Recipe& recipe, std::uint32_t scenario) {
  return ShownPath(recipe.file) + ": scenario " + std::to_string(scenario) + ": ";
}

/// Checks that nothing is chosen that recordings already say.
void CheckChoices(const Recipe& recipe, const DatasetChoices& choices) {
  if (!recipe.has_plans()) return;
  const DatasetChoices usual;
  const std::string rule = ": must be left out: the bases are plans for recordings";
  if (choices.fields != usual.fields) throw InputError("--fields" + rule);
  if (choices.is_merged) throw InputError("--merged" + rule);
  if (!choices.isa.empty()) throw InputError("--isa" + rule);
  for (const RecipeBase& base : recipe.bases) {
    InsertChoices insert;
    insert.recording = base.run->recording();
    insert.directory = choices.directory;
    CheckIsApart(insert);
  }
}

/// Checks that a scenario of the recipe can be certified if this is asked for. Mostly, the first
/// one can be.
void CheckCertify(const ScenarioDrawer& drawer, const DatasetChoices& choices) {
  if (!choices.must_certify || !CertifiedShareOf(choices.certify)) return;
  const Recipe& recipe = drawer.recipe();
  for (std::uint32_t i = 0; i < recipe.num_scenarios; ++i) {
    const DrawnScenario drawn = drawer.Draw(i);
    const bool can_certify = AtPlace(PlaceOf(recipe, i), [&] {
      return drawn.run ? Inserter::CanCertify(PlanOf(drawn))
                       : !EffectsOf(drawn.scenario).dense_footprint;
    });
    if (can_certify) return;
  }
  throw InputError("--certify: must be left out: all scenarios of " + ShownPath(recipe.file) +
                   (recipe.has_plans() ? " have no objects, or" : "") +
                   " are of fidelity reference, which it compares with");
}

RunPlan PlanScenario(const Recipe& recipe,
                     const DatasetChoices& choices,
                     std::uint32_t number,
                     ScenarioSpec scenario) {
  AtPlace(ShownPath(recipe.file) + ": /", [&] { CheckNamesOfFolders(scenario); });
  return PlanRun(std::move(scenario), ChoicesOfScenario(recipe, choices, number),
                 ShownPath(recipe.file) + ": scenario " + std::to_string(number));
}

/// Checks that the first scenario of a new data set can be made as chosen, before its folder is
/// taken: with other choices the folder would be that of another data set.
void CheckFirstScenario(const ScenarioDrawer& drawer, const DatasetChoices& choices) {
  const Recipe& recipe = drawer.recipe();
  const std::uint32_t number = choices.shard.ScenarioAt(0);
  if (fs::exists(choices.directory / kDatasetFile) || number >= recipe.num_scenarios) return;
  DrawnScenario drawn = drawer.Draw(number);
  if (drawn.run) {
    AtPlace(PlaceOf(recipe, number), [&] { static_cast<void>(PlanOf(drawn)); });
    return;
  }
  RunPlan plan = PlanScenario(recipe, choices, number, std::move(drawn.scenario));
  if (!plan.is_merged) return;
  const FrameMaker maker(plan.scenario, choices.num_threads, choices.isa);
  SetFrames(maker, plan);
  CheckCanMerge(maker, plan);
}

DatasetSpec CheckedSpec(const ScenarioDrawer& drawer, const DatasetChoices& choices) {
  CheckCertify(drawer, choices);
  CheckFirstScenario(drawer, choices);
  return SpecOfDataset(drawer.recipe(), choices, drawer.bases());
}

/// Lets a scenario be gone on with whose folder is known to be the data set's, even if it does not
/// say so any more.
void ClaimFolders(const RunPlan& plan) {
  for (const SensorPlan& sensor : plan.sensors) {
    MakeFolders(sensor.spec.directory);
    WriteFileWhole(sensor.spec.directory / kRunFile, RunJson(sensor.spec));
  }
}

/// Makes the sequences of a shard, of several scenarios at once.
class DatasetRun {
 public:
  DatasetRun(const Recipe& recipe, const DatasetChoices& choices, const DatasetHooks& hooks)
      : recipe_(recipe),
        choices_(choices),
        hooks_(hooks),
        drawer_(recipe),
        directory_(CheckedSpec(drawer_, choices)),
        scenery_(directory_.spec().record.isa) {}

  DatasetResult Run() {
    const auto begin = std::chrono::steady_clock::now();
    result_.num_scenarios = choices_.shard.NumOf(recipe_.num_scenarios);
    const bool is_checked = directory_.Check([this](double share) {
      if (directory_.is_complete()) {
        hooks_.on_progress({0, result_.num_scenarios, share * result_.num_scenarios});
      }
      return !hooks_.is_stopped();
    });
    result_.was_complete = directory_.is_complete();
    result_.changed = directory_.changed();
    result_.num_resumed = directory_.num_done() + directory_.num_kept();
    if (!result_.was_complete && is_checked) MakeMissing();
    result_.num_frames = num_frames_;
    result_.num_done = directory_.num_done();
    const bool has_all = is_checked && result_.num_done == result_.num_scenarios;
    if (has_all && !result_.was_complete) {
      directory_.Sync();
      if (choices_.shard.is_whole()) {
        result_.parts = WriteDatasetFiles(directory_.spec());
      } else {
        WriteShardManifest(directory_.spec());
      }
    }
    result_.is_complete = has_all;
    result_.elapsed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result_;
  }

 private:
  void MakeMissing() {
    const std::uint32_t num_done = directory_.num_done();
    const ScenarioWork work = {
        .make = [&](const ScenarioTurn& turn) { return Make(num_done + turn.index, turn); },
        .keep = [this](const std::string& line) { directory_.Append(line); },
        .on_progress =
            [this](double num_beyond) {
              hooks_.on_progress({directory_.num_done(), result_.num_scenarios, num_beyond});
            },
        .is_stopped = hooks_.is_stopped};
    // Putting things into a recording takes all threads for itself.
    const std::uint32_t num_at_once =
        recipe_.has_plans() ? 1 : std::numeric_limits<std::uint32_t>::max();
    TakeTurns(result_.num_scenarios - num_done, choices_.num_threads, num_at_once, work);
  }

  // Returns the line of one of the shard's scenarios; nothing if it was stopped.
  std::optional<std::string> Make(std::uint32_t of_shard, const ScenarioTurn& turn) {
    if (const std::string* const kept = directory_.Kept(of_shard)) return *kept;
    const std::uint32_t number = choices_.shard.ScenarioAt(of_shard);
    // What is there of a scenario is the data set's, even where its line is lost.
    const bool is_known = fs::exists(choices_.directory / SequenceFolderOf(number));
    DrawnScenario drawn = drawer_.Draw(number);
    if (drawn.run) return MakeOfPlan(number, is_known, drawn, turn);
    RunPlan plan = PlanScenario(recipe_, choices_, number, std::move(drawn.scenario));
    FrameMaker maker(plan.scenario, MakeSimulators(plan.scenario, turn.num_threads, scenery_));
    SetFrames(maker, plan);
    // A recipe may draw the reference itself for some of its scenarios, which needs no certificate.
    for (std::size_t i = 0; i < plan.sensors.size(); ++i) {
      if (maker.simulator(i).spec().detector.effects.dense_footprint) {
        plan.sensors[i].spec.certify.reset();
      }
    }
    if (is_known) ClaimFolders(plan);
    if (plan.is_merged) CheckCanMerge(maker, plan);
    if (!MakeScenario(turn, maker, plan)) return std::nullopt;
    if (plan.is_in_folders()) {
      drawn.record.sensors_hash = ContentHash(ReadFileWhole(plan.directory / kSensorsFile));
    }
    for (std::size_t i = 0; i < plan.sensors.size(); ++i) {
      drawn.record.sequences.push_back(RecordOf(maker, maker.pattern(i), plan.sensors[i]));
    }
    return RecordText(drawn.record);
  }

  // As Make().
  std::optional<std::string> MakeOfPlan(std::uint32_t number,
                                        bool is_known,
                                        DrawnScenario& drawn,
                                        const ScenarioTurn& turn) {
    const fs::path directory = choices_.directory / SequenceFolderOf(number);
    const RunHooks hooks = {[&](std::uint32_t num_done, std::uint32_t num_frames) {
                              turn.on_progress(static_cast<double>(num_done) / num_frames);
                            },
                            turn.is_stopped};
    const InsertResult made = AtPlace(PlaceOf(recipe_, number), [&] {
      return MakeInserted(drawn, choices_, directory, is_known, hooks);
    });
    num_frames_ += made.num_done - made.num_resumed;
    if (!made.is_complete) return std::nullopt;
    drawn.record.sequences = {RecordOfInserted(drawn, choices_.directory, directory)};
    return RecordText(drawn.record);
  }

  // Returns whether all of it is there; not if the run was stopped.
  [[nodiscard]] bool MakeScenario(const ScenarioTurn& turn, FrameMaker& maker, RunPlan& plan) {
    // Frames so large that they are made one after another keep all threads busy.
    std::unique_lock<std::mutex> memory;
    if (!turn.is_alone && maker.NumAtOnce() == 1) {
      memory = turn.await_memory();
      for (std::size_t i = 0; i < maker.num_sensors(); ++i) {
        maker.simulator(i).UseThreads(turn.num_threads_of_run);
      }
    }
    SequenceHooks hooks = {[&](std::uint32_t num_done, std::uint32_t num_frames) {
                             turn.on_progress(static_cast<double>(num_done) / num_frames);
                           },
                           turn.is_stopped};
    hooks.is_alone = turn.is_alone;
    const auto ignore = [](const SensorPlan&, const FidelityChoice&) {};
    if (!ChooseFidelities(maker, ignore, hooks, plan)) return false;
    UseCertificates(maker, plan);
    const PlanResult made = MakeFrames(maker, plan, RunFolders(plan), hooks);
    for (const SequenceResult& each : made.sequences) {
      num_frames_ += each.num_done - each.num_resumed;
    }
    return made.is_complete;
  }

  // What scenarios.jsonl says of a sequence.
  [[nodiscard]] SequenceRecord RecordOf(const FrameMaker& maker,
                                        const ScanPattern& pattern,
                                        const SensorPlan& sensor) const {
    const SequenceSpec& spec = sensor.spec;
    const fs::path file = spec.directory / kManifestFile;
    const auto manifest = ReadRecord<ManifestRecord>(ReadManifestText(file), ShownPath(file));
    SequenceRecord record{
        .sensor = sensor.name,
        .folder = spec.directory.lexically_relative(choices_.directory).generic_string(),
        .num_frames = spec.num_frames,
        .points = manifest.counts.points,
        .scenario_hash = spec.identity.scenario_hash,
        .data_hash = manifest.data_hash,
        .manifest_hash = HashFile(file).hash,
        .trace = spec.trace};
    for (std::uint32_t i = 0; i < spec.num_frames; ++i) {
      const std::int64_t stamp_ns = pattern.StampNs(spec.FrameAt(i));
      const RailWorld& world = *maker.StateAt(stamp_ns).world;
      record.vehicle_s_m.push_back(world.VehicleChainage_m(stamp_ns));
      record.vehicle_speed_mps.push_back(world.VehicleSpeed_mps(stamp_ns));
    }
    if (!spec.bag.empty()) record.bag = {spec.bag, spec.cloud_topics};
    return record;
  }

  const Recipe& recipe_;
  const DatasetChoices& choices_;
  const DatasetHooks& hooks_;
  ScenarioDrawer drawer_;
  DatasetDirectory directory_;
  SharedScenery scenery_;
  std::atomic<std::uint64_t> num_frames_ = 0;
  DatasetResult result_;
};

}  // namespace

DatasetResult RunDataset(const Recipe& recipe,
                         const DatasetChoices& choices,
                         const DatasetHooks& hooks) {
  CheckChoices(recipe, choices);
  return DatasetRun(recipe, choices, hooks).Run();
}

}  // namespace railcast
