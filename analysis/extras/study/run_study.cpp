#include "analysis/extras/study/run_study.h"

#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/extras/study/approach_scan.h"
#include "analysis/extras/study/study_directory.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/recipe/recipe_files.h"
#include "core/extras/recipe/scenario_draw.h"
#include "core/extras/recipe/scenario_turns.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/program/version.h"
#include "core/trace/trace_program.h"

namespace railcast {
namespace {

int NumThreadsOf(const StudyChoices& choices) {
  return choices.num_threads > 0 ? choices.num_threads : tbb::info::default_concurrency();
}

/// Scanners that wait for their next approach. Each keeps a scene, so that whoever needs one gets
/// that of the same scene, if it can be had.
class ScannerPool {
 public:
  /// @param study Must outlive the pool.
  ScannerPool(const StudySpec& study, const StudyChoices& choices)
      : study_(study),
        isa_(choices.isa),
        certify_(choices.certify),
        num_most_(static_cast<std::size_t>(NumThreadsOf(choices)) + kMostIdle) {}

  [[nodiscard]] std::unique_ptr<ApproachScanner> Take(const ScenarioSpec& scenario,
                                                      int num_threads) {
    const std::lock_guard lock(mutex_);
    for (auto idle = idle_.begin(); idle != idle_.end(); ++idle) {
      if (!(*idle)->HasSceneOf(scenario)) continue;
      return TakeFrom(idle);
    }
    if (num_made_ < num_most_ || idle_.empty()) {
      ++num_made_;
      return std::make_unique<ApproachScanner>(num_threads, isa_, study_.gauge, study_.objects,
                                               certify_);
    }
    return TakeFrom(idle_.begin());  // The one that has been idle for longest.
  }

  void Return(std::unique_ptr<ApproachScanner> scanner) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(scanner));
  }

  [[nodiscard]] ApproachScanner::Effort Effort() const {
    ApproachScanner::Effort sum;
    for (const auto& scanner : idle_) {
      sum.num_frames += scanner->effort().num_frames;
      sum.num_traced += scanner->effort().num_traced;
    }
    return sum;
  }

 private:
  using Idle = std::list<std::unique_ptr<ApproachScanner>>;
  // Beside those at work, some that keep the scenes of other sensors.
  static constexpr std::size_t kMostIdle = 4;

  std::unique_ptr<ApproachScanner> TakeFrom(Idle::iterator idle) {
    std::unique_ptr<ApproachScanner> taken = std::move(*idle);
    idle_.erase(idle);
    return taken;
  }

  const StudySpec& study_;
  std::string isa_;
  std::optional<double> certify_;
  std::size_t num_most_;
  std::mutex mutex_;
  Idle idle_;
  std::size_t num_made_ = 0;
};

std::vector<std::uint32_t> FramesOf(const Recipe& recipe) {
  std::vector<std::uint32_t> frames;
  for (std::uint32_t i = 0; i < recipe.num_frames; ++i) {
    frames.push_back(recipe.warm_up_frames + i * recipe.stride);
  }
  return frames;
}

// What is asked about must be in some scenario. Most often the first one has it all.
void CheckAreThere(const StudySpec& study, const ScenarioDrawer& drawer) {
  std::vector<std::string> missing = study.objects;
  for (std::uint32_t i = 0; i < drawer.recipe().num_scenarios && !missing.empty(); ++i) {
    const auto world = MakeWorld(drawer.Draw(i).scenario);
    std::erase_if(missing, [&](const std::string& asked) {
      return std::ranges::any_of(world->objects(), [&](const SceneObject& object) {
        return IsAskedAbout(object.name, {asked});
      });
    });
  }
  if (missing.empty()) return;
  const auto at = std::ranges::find(study.objects, missing.front()) - study.objects.begin();
  throw InputError(ShownPath(study.file) + ": /objects/" + std::to_string(at) +
                   ": must be an object of a scenario (got " + Quoted(missing.front()) + ")");
}

/// Nothing if it was stopped.
std::optional<ApproachRecord> RecordBy(ApproachScanner& scanner,
                                       const StudySpec& study,
                                       const DrawnScenario& drawn,
                                       const std::vector<std::uint32_t>& frames,
                                       const std::function<bool()>& is_stopped) {
  if (!study.detector) {
    const auto courses = scanner.Follow(drawn.scenario, frames, study.detect.rule, is_stopped);
    if (!courses) return std::nullopt;
    return RecordOf(drawn, *courses, frames, study.detect);
  }
  const auto run =
      scanner.Evaluate(drawn.scenario, frames, *study.detector, study.detect, is_stopped);
  if (!run) return std::nullopt;
  // What the detector reports is seen.
  DetectSpec detect = study.detect;
  detect.rule.min_points = 1;
  ApproachRecord record = RecordOf(drawn, run->run.courses, frames, detect);
  record.alarms = AlarmsOf(*run);
  return record;
}

ApproachMaker MakerBy(const StudySpec& study,
                      const Recipe& recipe,
                      std::shared_ptr<ScannerPool> scanners) {
  return [&study, &recipe, frames = FramesOf(recipe), scanners = std::move(scanners)](
             const DrawnScenario& drawn, int num_threads, const std::function<bool()>& is_stopped) {
    return AtPlace(PlaceOfScenario(recipe, drawn.record.scenario), [&] {
      CheckIsStudied(drawn.scenario);
      auto scanner = scanners->Take(drawn.scenario, num_threads);
      auto record = RecordBy(*scanner, study, drawn, frames, is_stopped);
      if (record) record->certificate = scanner->certificate();
      scanners->Return(std::move(scanner));
      return record;
    });
  };
}

}  // namespace

std::string PlaceOfScenario(const Recipe& recipe, std::uint32_t number) {
  return ShownPath(recipe.file.lexically_normal()) + ": scenario " + std::to_string(number) + ": ";
}

void CheckIsStudied(const ScenarioSpec& scenario) {
  if (scenario.fidelity == Fidelity::kAuto) {
    throw InputError(
        "/fidelity: must name a rung: a study says which model it used (got \"auto\")");
  }
  if (scenario.lidars.size() > 1) {
    throw InputError("/lidars: must be one sensor: choose it by the recipe's /sensor");
  }
}

ApproachMaker MakerOfApproaches(const StudySpec& study,
                                const Recipe& recipe,
                                const StudyChoices& choices) {
  return MakerBy(study, recipe, std::make_shared<ScannerPool>(study, choices));
}

StudyRecord IdentityOfStudy(const StudySpec& study,
                            const ScenarioDrawer& drawer,
                            const StudyChoices& choices) {
  const Recipe& recipe = drawer.recipe();
  CheckAreThere(study, drawer);
  StudyRecord identity{.version = ProgramVersion(),
                       .embree = EmbreeVersion(),
                       .isa = AtPlace("--", [&] { return IsaInUse(choices.isa); }),
                       .study_hash = ContentHash(ReadFileWhole(study.file)),
                       .recipe_hash = ContentHash(ReadFileWhole(recipe.file)),
                       .files_hash = HashOfRecipeFiles(recipe),
                       .num_scenarios = recipe.num_scenarios,
                       .frames = {recipe.warm_up_frames, recipe.stride, recipe.num_frames},
                       .certify = choices.certify};
  for (std::size_t i = 0; i < recipe.bases.size(); ++i) {
    identity.base_hashes.push_back(drawer.bases().hash(i));
  }
  return identity;
}

Recipe ReadStudyRecipe(const StudySpec& study) {
  return ReadRecipe(
      std::filesystem::path(study.recipe).lexically_proximate(std::filesystem::current_path()));
}

StudyResult RunStudy(const StudySpec& study,
                     const ScenarioDrawer& drawer,
                     const StudyChoices& choices,
                     const StudyHooks& hooks) {
  const auto begin = std::chrono::steady_clock::now();
  const Recipe& recipe = drawer.recipe();
  StudyResult result;
  result.identity = IdentityOfStudy(study, drawer, choices);
  StudyDirectory directory(choices.directory, result.identity, choices.shard);
  result.num_approaches = choices.shard.NumOf(recipe.num_scenarios);
  if (!choices.shards.empty()) {
    MergeStudies(choices.shards, result.identity, directory);
  }
  const auto scanners = std::make_shared<ScannerPool>(study, choices);
  const ApproachMaker make_approach = MakerBy(study, recipe, scanners);
  const std::uint32_t num_before = directory.num_done();
  const auto make = [&](const ScenarioTurn& turn) -> std::optional<std::string> {
    const DrawnScenario drawn = drawer.Draw(choices.shard.ScenarioAt(num_before + turn.index));
    const auto record = make_approach(drawn, turn.num_threads, turn.is_stopped);
    if (!record) return std::nullopt;
    return RecordText(*record);
  };
  TakeTurns(result.num_approaches - num_before, NumThreadsOf(choices),
            std::numeric_limits<std::uint32_t>::max(),
            {.make = make,
             .keep = [&](const std::string& line) { directory.Append(line); },
             .on_progress =
                 [&](double num_beyond) {
                   hooks.on_progress(directory.num_done() + static_cast<std::uint32_t>(num_beyond),
                                     result.num_approaches);
                 },
             .is_stopped = hooks.is_stopped});
  directory.Sync();
  result.approaches = directory.Read();
  result.num_made = directory.num_done() - num_before;
  result.num_frames = scanners->Effort().num_frames;
  result.num_traced = scanners->Effort().num_traced;
  result.elapsed_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace railcast
