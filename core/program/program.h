#pragma once

#include <signal.h>

#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/program/options.h"

namespace railcast {

/// Returns the signals that ask a program to end cleanly: SIGINT, SIGTERM and SIGHUP. SIGHUP is
/// left out where it is ignored, as under nohup.
[[nodiscard]] inline std::vector<int> StopSignals() {
  std::vector<int> signals = {SIGINT, SIGTERM};
  struct sigaction hangup {};
  ::sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) signals.push_back(SIGHUP);
  return signals;
}

/// Exit statuses of all programs.
inline constexpr int kExitSuccess = 0;
inline constexpr int kExitFailure = 1;        ///< Bad input or a failed run.
inline constexpr int kExitUsage = 2;          ///< The command line is invalid.
inline constexpr int kExitInterrupted = 130;  ///< The status of shells after Ctrl-C.

/// Runs a program's `main` and handles the ways in which it may end.
///
/// An exception becomes the last line on `complaints`: the text of an InputError as it is, that of
/// any other exception after the program's name. If memory runs out where nothing can be thrown,
/// the program ends with such a line, too, instead of aborting. All output to stdout must have been
/// written: a full disk or a closed stdout makes the run fail.
///
/// Before that, the numbers of closed standard streams are taken, so that no file or socket of the
/// program gets one and receives the text that was meant for the stream. A write to a file that
/// grows beyond `ulimit -f` becomes an error of that write instead of ending the program.
/// @param program Its name, for example "railcast-view".
/// @param complaints Gets one line, "stdout: no space left on device", if output to stdout was
///   lost.
/// @return What `main` returns; kExitFailure if it throws, or if that is 0 and output was lost.
[[nodiscard]] int RunProgram(const std::string& program,
                             const std::function<int()>& main,
                             std::ostream& complaints);

/// The work that a command line asks for. It gets the command line itself, for use in reports, and
/// returns the exit status.
/// @throws InputError on bad input.
using ProgramCommand = std::function<int(const std::string& command_line)>;

/// The commands that extras add to a program: by its name, what adds a command with its options.
using ExtraCommands =
    std::map<std::string_view, void (*)(ProgramOptions& app, ProgramCommand& command)>;

/// Adds a command of an extra. In a railcast without the extra, the command says so.
/// @param built All that there are in this railcast.
void AddExtraCommand(const ExtraCommands& built,
                     const std::string& name,
                     const std::string& extra,
                     ProgramOptions& app,
                     ProgramCommand& command);

/// What distinguishes one program from another.
struct ProgramSpec {
  std::string name;         ///< For example "railcast-view".
  std::string description;  ///< The first line of `--help`.
  std::string footer;       ///< The last lines of `--help`.
  /// Adds the program's options and commands. Once the line is parsed, `command` must hold the
  /// work.
  std::function<void(ProgramOptions& app, ProgramCommand& command)> add;
};

/// The body of every program's `main`: parses the command line, explains what is wrong with it, or
/// runs the command and reports how it ended. Where the extras are installed, their program of the
/// same name, in libexec/railcast, takes the place of this one: it has what this one lacks.
/// @return The exit status.
///
///     int main(int argc, char** argv) {
///       return railcast::ProgramMain({.name = "railcast-view", ..., .add = AddView}, argc, argv);
///     }
[[nodiscard]] int ProgramMain(const ProgramSpec& spec, int argc, char** argv);

}  // namespace railcast
