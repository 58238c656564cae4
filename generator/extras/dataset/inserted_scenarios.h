#pragma once

#include <filesystem>
#include <memory>

#include "core/extras/recipe/recipe.h"
#include "core/extras/recipe/scenario_draw.h"
#include "core/scenario/json_text.h"
#include "generator/extras/dataset/run_dataset.h"
#include "generator/extras/insert/plan/recorded_run.h"
#include "generator/extras/insert/run/insert_run.h"

namespace railcast {

// Scenarios of a data set that are plans for recordings.

/// Reads a plan and its recording for recipes (RecordingReader).
/// @throws InputError as ReadRecordedRun() does.
[[nodiscard]] std::shared_ptr<const RecordedBase> ReadRecordedBase(
    const std::filesystem::path& plan_file, const std::filesystem::path& recording);

/// What was read.
/// @pre ReadRecordedBase() made the base.
[[nodiscard]] const RecordedRun& RunOf(const RecordedBase& base);

/// @throws InputError as MakeInsertPlan() does.
[[nodiscard]] InsertPlan PlanOf(const DrawnScenario& drawn);

/// Puts a drawn plan into its recording, in a folder that `insert` writes, or goes on with it. Its
/// frames have certificates if they are asked for and the plan can have them.
/// @param directory Of this scenario.
/// @param is_known Whether the directory is known to be the scenario's, whatever it says.
/// @throws InputError as MakeInsertPlan() and RunInsert() do.
[[nodiscard]] InsertResult MakeInserted(const DrawnScenario& drawn,
                                        const DatasetChoices& choices,
                                        const std::filesystem::path& directory,
                                        bool is_known,
                                        const RunHooks& hooks);

/// What scenarios.jsonl says of it when it is complete: as of a sequence, which is its folder
/// `recording`, and the hashes of all files of the scenario.
/// @throws InputError with a line for each file that is not as it was written, or not its own.
[[nodiscard]] SequenceRecord RecordOfInserted(const DrawnScenario& drawn,
                                              const std::filesystem::path& dataset,
                                              const std::filesystem::path& directory);

}  // namespace railcast
