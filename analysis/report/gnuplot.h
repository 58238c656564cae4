#pragma once

#include <filesystem>
#include <string>

namespace railcast {

/// Text in quotes, as gnuplot reads it; to be drawn with terminals that are `noenhanced`. Single
/// quotes: between double ones gnuplot runs what stands between backquotes.
[[nodiscard]] std::string GnuplotQuoted(const std::string& text);

/// A number to six digits, as a chart shows no more; "NaN" for what is none.
[[nodiscard]] std::string GnuplotNumber(double value);

/// What gnuplot writes to stdout for a script, after `settings`: gnuplot commands without double
/// quotes, such as "set terminal svg".
/// @throws InputError if gnuplot is not installed or fails.
[[nodiscard]] std::string GnuplotOutput(const std::filesystem::path& script,
                                        const std::string& settings);

}  // namespace railcast
