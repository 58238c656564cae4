#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "core/io/command_line.h"
#include "core/io/run_program.h"

namespace railcast {

/// What the command line asked for; it is told that line, for reports to name, and gives the exit
/// status.
/// @throws InputError on bad input.
using Command = std::function<int(const std::string& command_line)>;

// Each adds one command with its options; if the command line names it, `command` becomes it.

/// Dropout, density, noise, intensity and coverage of recordings, ours or anybody's.
void AddStats(CLI::App& app, Command& command);
/// Measures how far two recordings are apart, or what each effect of a scenario changes.
void AddCompare(CLI::App& app, Command& command);
/// From how far objects are detected, against the way that a train needs to stop.
void AddDetect(CLI::App& app, Command& command);
/// Estimates the sensor models' parameters from recordings.
void AddFit(CLI::App& app, Command& command);
/// Charts speed against accuracy on a scenario.
void AddFrontier(CLI::App& app, Command& command);
/// Compares a sequence directory with the hashes that it was written with.
void AddVerify(CLI::App& app, Command& command);
/// Counts a live stream in the railcast protocol, and keeps it if asked to, until a signal ends it.
void AddReceive(CLI::App& app, Command& command);

}  // namespace railcast
