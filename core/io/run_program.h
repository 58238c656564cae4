#pragma once

#include <functional>
#include <iosfwd>
#include <string>

namespace railcast {

/// Exit statuses of all programs.
inline constexpr int kExitSuccess = 0;
inline constexpr int kExitFailure = 1;        ///< Bad input or a failed run.
inline constexpr int kExitUsage = 2;          ///< The command line is none that the program knows.
inline constexpr int kExitInterrupted = 130;  ///< As shells report a program ended by Ctrl-C.

/// Runs a program's `main` and sees to how it ends.
///
/// What it throws becomes its last line on `complaints`: an InputError as it is, anything else
/// behind the program's name. Memory that runs out where nothing can be thrown ends the program
/// with such a line, too, instead of an abort. What it said on stdout must have arrived: a full
/// disk or a closed stdout is a failed run, not a silent one.
///
/// Before, it takes the numbers of standard streams that are closed, so that no file or socket of
/// the program gets one and with it the text that was meant for the stream. And it sees to it that
/// a file that grows beyond `ulimit -f` is an error of its writer's, not the program's end.
/// @param program Its name, for example "railcast-view".
/// @param complaints Gets one line, "stdout: no space left on device", if that has not arrived.
/// @return What `main` returns; kExitFailure if it throws, or if that is 0 and something was lost.
[[nodiscard]] int RunProgram(const std::string& program,
                             const std::function<int()>& main,
                             std::ostream& complaints);

}  // namespace railcast
