#pragma once

#include <string>

namespace railcast {

/// Runs a program that a report needs and returns its standard output.
/// @param command A shell's command line that begins with the program's name.
/// @param package Debian's package that has the program.
/// @throws InputError if the program is not found or fails; it says that the numbers are written.
[[nodiscard]] std::string ProgramOutput(const std::string& command, const std::string& package);

}  // namespace railcast
