#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/run/run_folder.h"
#include "core/program/command_line.h"
#include "core/program/program.h"

namespace railcast {

// Each function adds one command with its options and sets `command` to it if the command line
// names it.

/// Reports dropout, density, noise, intensity and coverage of recordings, ours or foreign.
void AddStats(ProgramOptions& app, ProgramCommand& command);
/// Says what a recording is, what is wrong with it, and what it is fit for.
void AddInspect(ProgramOptions& app, ProgramCommand& command);
/// Measures how far two recordings are apart, or what each effect of a scenario changes.
void AddCompare(ProgramOptions& app, ProgramCommand& command);
/// Compares the distance at which objects are detected with the distance a train needs to stop.
void AddDetect(ProgramOptions& app, ProgramCommand& command);
/// Charts speed against accuracy on a scenario.
void AddFrontier(ProgramOptions& app, ProgramCommand& command);
/// Compares a sequence directory with the hashes that it was written with.
void AddVerify(ProgramOptions& app, ProgramCommand& command);
/// Counts, and on request records, a live stream in the railcast protocol until a signal ends it.
void AddReceive(ProgramOptions& app, ProgramCommand& command);

// What several commands do with their options.

/// Checks that no source is given twice, since its samples would be counted twice and the intervals
/// would be too narrow.
/// @throws InputError if two paths lead to the same source.
inline void CheckDistinct(const std::vector<std::filesystem::path>& sources) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& source : sources) {
    if (seen.insert(FollowedPath(source)).second) continue;
    throw InputError(ShownPath(source) + ": must be named once");
  }
}

}  // namespace railcast
