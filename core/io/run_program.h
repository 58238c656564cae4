#pragma once

#include <functional>
#include <iosfwd>

namespace railcast {

/// Runs a program's `main` and sees to it that what it said on stdout has arrived: a full disk or a
/// closed stdout is a failed run, not a silent one.
///
/// Before, it takes the numbers of standard streams that are closed, so that no file or socket of
/// the program gets one and with it the text that was meant for the stream.
/// @param complaints Gets one line, "stdout: no space left on device", if it has not.
/// @return What `main` returns; 1 if that is 0 and something was lost.
[[nodiscard]] int RunProgram(const std::function<int()>& main, std::ostream& complaints);

}  // namespace railcast
