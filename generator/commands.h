#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "core/program/command_line.h"
#include "core/program/program.h"

namespace railcast {

inline constexpr const char* kExitStatusText =
    "Exit status: 0 success, 1 bad input or failed run, 2 usage.";

/// A command of an extra: a program of its own, so that the others need not load what it is linked
/// with.
struct OwnProgram {
  const char* command;
  const char* description;
  const char* program;  ///< Stands beside railcast-generate.
  const char* extra;    ///< The extra that has the command.
};

/// All of them, whether or not they are there.
inline constexpr auto kOwnPrograms = std::to_array<OwnProgram>(
    {{"insert",
      "Put objects and weather into a recording; run the same command again to continue an "
      "interrupted run",
      "railcast-recordings", "insert"},
     {"convert",
      "Write a recording or a data set in another format; run the same command again to continue "
      "an interrupted run",
      "railcast-recordings", "convert"},
     {"replay", "Send a recording at its own pace, faster, or step by step", "railcast-recordings",
      "replay"},
     {"dataset",
      "Write labelled frames of many scenarios, drawn as a recipe says; run the same command again "
      "to continue an interrupted run",
      "railcast-recordings", "dataset"},
     {"merge",
      "Make one data set of the folders of all its shards, byte for byte as a run without shards "
      "makes it",
      "railcast-recordings", "dataset"},
     {"survey", "Make the scene of a scenario from recordings with poses or from survey clouds",
      "railcast-recordings", "survey"},
     {"import", "Fit the lines of a map and write them as alignments", "railcast-import",
      "import"}});

[[nodiscard]] consteval const OwnProgram& OwnProgramOf(std::string_view command) {
  return *std::ranges::find(kOwnPrograms, command, &OwnProgram::command);
}

/// Runs the program with what follows on the command line. Where it is not there, the command says
/// how it comes.
void AddOwnProgram(const OwnProgram& own, ProgramOptions& app, ProgramCommand& command);

// Each function adds one command with its options to railcast-generate. If the command line names
// it, `command` becomes its work.

/// Writes a sequence directory, or finishes an interrupted one.
void AddSequence(ProgramOptions& app, ProgramCommand& command);
/// Sends frames live, at the pace of real sensors, until stopped.
void AddStream(ProgramOptions& app, ProgramCommand& command);
/// Prints a report on a scenario and its scene, or the resolved scenario alone.
void AddCheck(ProgramOptions& app, ProgramCommand& command);
/// Writes the scene as triangles: a stretch of the line, or the window of frame 0.
void AddWorld(ProgramOptions& app, ProgramCommand& command);
/// Replays one firing and prints what each effect made of it.
void AddTrace(ProgramOptions& app, ProgramCommand& command);

}  // namespace railcast
