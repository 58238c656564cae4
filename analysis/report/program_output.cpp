#include "analysis/report/program_output.h"

#include <sys/wait.h>

#include <array>
#include <cstdio>

#include "core/base/error.h"

namespace railcast {

std::string ProgramOutput(const std::string& command, const std::string& package) {
  constexpr int kExitNotFound = 127;  // Exit status of the shell.
  const std::string program = command.substr(0, command.find(' '));
  FILE* const pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
  Check(pipe != nullptr, "a pipe can be opened");
  std::string bytes;
  std::array<char, 65536> buffer{};
  std::size_t count = 0;
  while ((count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
    bytes.append(buffer.data(), count);
  }
  const int status = ::pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kExitNotFound) {
    throw InputError(program + ": not found; install " + package + " (the numbers are written)");
  }
  if (status != 0) throw InputError(program + ": failed (the numbers are written)");
  return bytes;
}

}  // namespace railcast
