#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace railcast {

struct Ended {
  int status{};
  std::string said;  ///< stdout and stderr together.
};

/// Runs a shell command.
inline Ended RunCommand(const std::string& command) {
  FILE* pipe = ::popen(("{ " + command + "; } 2>&1").c_str(), "r");
  Ended run;
  std::array<char, 4096> buffer{};
  std::size_t count = 0;
  while ((count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
    run.said.append(buffer.data(), count);
  }
  run.status = WEXITSTATUS(::pclose(pipe));
  return run;
}

/// Whether Open3D is installed. Debian's package belongs to Debian's interpreter, which need not be
/// the first on the path.
inline bool HasOpen3d() {
  return RunCommand("/usr/bin/python3 -c 'import open3d'").status == 0;
}

/// Whether Wireshark's program for terminals is installed.
inline bool HasTshark() {
  return RunCommand("command -v tshark").status == 0;
}

}  // namespace railcast
