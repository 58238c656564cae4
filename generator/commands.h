#pragma once

#include <string>

#include "core/program/command_line.h"
#include "core/program/program.h"

namespace railcast {

inline constexpr const char* kExitStatusText =
    "Exit status: 0 success, 1 bad input or failed run, 2 usage.";

/// A command that is a program of its own, so that the others need not load what it is linked with.
struct OwnProgram {
  std::string command;
  std::string description;
  std::string program;  ///< Stands beside railcast-generate.
  std::string package;  ///< Of Debian.
};

inline constexpr const char* kImportDescription =
    "Fit the lines of a map and write them as alignments";
inline constexpr const char* kInsertDescription =
    "Put objects and weather into a recording; run the same command again to continue an "
    "interrupted run";
inline constexpr const char* kConvertDescription =
    "Write a recording or a data set in another format; run the same command again to continue an "
    "interrupted run";
inline constexpr const char* kReplayDescription =
    "Send a recording at its own pace, faster, or step by step";
inline constexpr const char* kDatasetDescription =
    "Write labelled frames of many scenarios, drawn as a recipe says; run the same command again "
    "to continue an interrupted run";
inline constexpr const char* kMergeDescription =
    "Make one data set of the folders of all its shards, with the bytes of a run without shards";
inline constexpr const char* kSurveyDescription =
    "Make the scene of a scenario from recordings with poses or from survey clouds";

/// Runs the program with what follows on the command line.
void AddOwnProgram(const OwnProgram& own, ProgramOptions& app, ProgramCommand& command);

// Each function adds one command with its options to railcast-generate. If the command line names
// it, `command` becomes its work.

/// Writes a sequence directory, or finishes an interrupted one.
void AddSequence(ProgramOptions& app, ProgramCommand& command);
/// Puts objects and weather into a recording.
void AddInsert(ProgramOptions& app, ProgramCommand& command);
/// Writes a recording or a data set in another format.
void AddConvert(ProgramOptions& app, ProgramCommand& command);
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
/// Fits the lines of a map and writes them as alignments, in the program railcast-import.
void AddImport(ProgramOptions& app, ProgramCommand& command);
/// Makes the scene of a scenario from recordings or from survey clouds.
void AddSurvey(ProgramOptions& app, ProgramCommand& command);
/// Replays one firing and prints what each effect made of it.
void AddTrace(ProgramOptions& app, ProgramCommand& command);

}  // namespace railcast
