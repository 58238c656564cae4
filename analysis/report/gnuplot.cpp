#include "analysis/report/gnuplot.h"

#include <sys/wait.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "analysis/shell_word.h"
#include "core/base/error.h"

namespace railcast {
namespace {

constexpr int kExitNotFound = 127;  // Of a shell.

}  // namespace

std::string GnuplotQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += c;
    // A line's end would end the command.
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted += "'";
}

std::string GnuplotNumber(double value) {
  if (!std::isfinite(value)) return "NaN";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string GnuplotOutput(const std::filesystem::path& script, const std::string& settings) {
  const std::string command =
      "gnuplot -e \"" + settings + "\" " + ShellWord(script.string()) + " 2>/dev/null";
  FILE* const pipe = ::popen(command.c_str(), "r");
  Check(pipe != nullptr, "a pipe can be opened");
  std::string bytes;
  std::array<char, 65536> buffer{};
  std::size_t count = 0;
  while ((count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
    bytes.append(buffer.data(), count);
  }
  const int status = ::pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kExitNotFound) {
    throw InputError("gnuplot: not found; install gnuplot-nox (the numbers are written)");
  }
  if (status != 0) throw InputError("gnuplot: failed (the numbers are written)");
  return bytes;
}

}  // namespace railcast
