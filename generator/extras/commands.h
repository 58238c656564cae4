#pragma once

#include "generator/commands.h"

namespace railcast {

// The commands of extras, as generator/commands.h has those of railcast-generate itself.

/// Puts objects and weather into a recording.
void AddInsert(ProgramOptions& app, ProgramCommand& command);
/// Writes a recording or a data set in another format.
void AddConvert(ProgramOptions& app, ProgramCommand& command);
/// Sends a recording at its own pace, faster, or step by step.
void AddReplay(ProgramOptions& app, ProgramCommand& command);
/// Writes a data set of many scenarios that a recipe draws, or finishes an interrupted one.
void AddDataset(ProgramOptions& app, ProgramCommand& command);
/// Makes one data set of its shards.
void AddMerge(ProgramOptions& app, ProgramCommand& command);
/// Makes the scene of a scenario from recordings or from survey clouds.
void AddSurvey(ProgramOptions& app, ProgramCommand& command);
/// Fits the lines of a map and writes them as alignments, in the program railcast-import.
void AddImport(ProgramOptions& app, ProgramCommand& command);

}  // namespace railcast
