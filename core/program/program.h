#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace railcast {

/// The work that a command line asks for. It gets the command line itself, for use in reports, and
/// returns the exit status.
/// @throws InputError on bad input.
using ProgramCommand = std::function<int(const std::string& command_line)>;

/// What distinguishes one program from another.
struct ProgramSpec {
  std::string name;         ///< For example "railcast-view".
  std::string description;  ///< The first line of `--help`.
  std::string footer;       ///< The last lines of `--help`.
  /// Adds the program's options and commands. Once the line is parsed, `command` must hold the
  /// work.
  std::function<void(CLI::App& app, ProgramCommand& command)> add;
};

/// The body of every program's `main`: parses the command line, explains what is wrong with it, or
/// runs the command and reports how it ended (run_program.h).
/// @return The exit status.
///
///     int main(int argc, char** argv) {
///       return railcast::ProgramMain({.name = "railcast-view", ..., .add = AddView}, argc, argv);
///     }
[[nodiscard]] int ProgramMain(const ProgramSpec& spec, int argc, char** argv);

}  // namespace railcast
