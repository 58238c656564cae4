#pragma once

#include "core/program/command_line.h"
#include "core/program/program.h"

namespace railcast {

inline constexpr const char* kExitStatusText =
    "Exit status: 0 success, 1 bad input or failed run, 2 usage.";

// Each function adds one command with its options to railcast-generate. If the command line names
// it, `command` becomes its work.

/// Writes a sequence directory, or finishes an interrupted one.
void AddSequence(ProgramOptions& app, ProgramCommand& command);
/// Puts objects and weather into a recording.
void AddInsert(ProgramOptions& app, ProgramCommand& command);
/// Sends frames live, at the pace of real sensors, until stopped.
void AddStream(ProgramOptions& app, ProgramCommand& command);
/// Sends a recording at its own pace, faster, or step by step.
void AddReplay(ProgramOptions& app, ProgramCommand& command);
/// Prints a report on a scenario and its scene, or the resolved scenario alone.
void AddCheck(ProgramOptions& app, ProgramCommand& command);
/// Writes the scene as triangles: a stretch of the line, or the window of frame 0.
void AddWorld(ProgramOptions& app, ProgramCommand& command);
/// Writes a data set of many scenarios that a recipe draws, or finishes an interrupted one.
void AddDataset(ProgramOptions& app, ProgramCommand& command);
/// Makes one data set of its shards.
void AddMerge(ProgramOptions& app, ProgramCommand& command);
inline constexpr const char* kImportDescription =
    "Fit the lines of a map and write them as alignments";
/// Runs the program railcast-import, which stands beside railcast-generate, with what follows on
/// the command line. It is there if railcast was built with GDAL and PROJ (RAILCAST_BUILD_IMPORT).
void AddImportProgram(ProgramOptions& app, ProgramCommand& command);
/// Fits the lines of a map and writes them as alignments, in the program railcast-import.
void AddImport(ProgramOptions& app, ProgramCommand& command);
/// Makes the scene of a scenario from recordings or from survey clouds.
void AddSurvey(ProgramOptions& app, ProgramCommand& command);
/// Replays one firing and prints what each effect made of it.
void AddTrace(ProgramOptions& app, ProgramCommand& command);

}  // namespace railcast
