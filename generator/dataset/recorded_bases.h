#pragma once

#include <filesystem>
#include <memory>

#include "core/recipe/recorded_base.h"
#include "generator/insert/plan/recorded_run.h"

namespace railcast {

/// Reads a plan and its recording for recipes (RecordingReader).
/// @throws InputError as ReadRecordedRun() does.
[[nodiscard]] std::shared_ptr<const RecordedBase> ReadRecordedBase(
    const std::filesystem::path& plan_file, const std::filesystem::path& recording);

/// What was read.
/// @pre ReadRecordedBase() made it.
[[nodiscard]] const RecordedRun& RunOf(const RecordedBase& base);

}  // namespace railcast
