#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "core/program/command_line.h"
#include "core/program/program.h"

namespace railcast {

// Each function adds one command with its options and sets `command` to it if the command line
// names it.

/// Reports dropout, density, noise, intensity and coverage of recordings, ours or foreign.
void AddStats(CLI::App& app, ProgramCommand& command);
/// Measures how far two recordings are apart, or what each effect of a scenario changes.
void AddCompare(CLI::App& app, ProgramCommand& command);
/// Compares the distance at which objects are detected with the distance a train needs to stop.
void AddDetect(CLI::App& app, ProgramCommand& command);
/// Estimates the sensor models' parameters from recordings.
void AddFit(CLI::App& app, ProgramCommand& command);
/// Charts speed against accuracy on a scenario.
void AddFrontier(CLI::App& app, ProgramCommand& command);
/// Compares a real sensor's recording with what a preset would have measured in its place.
void AddPreset(CLI::App& app, ProgramCommand& command);
/// Compares a sequence directory with the hashes that it was written with.
void AddVerify(CLI::App& app, ProgramCommand& command);
/// Counts, and on request records, a live stream in the railcast protocol until a signal ends it.
void AddReceive(CLI::App& app, ProgramCommand& command);

}  // namespace railcast
