#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/support/run_command.h"

namespace railcast {

/// What a command takes.
struct Effort {
  double memory_kb{};  ///< At most.
  double cpu_s{};
};

inline Effort EffortOf(const std::string& command) {
  const Ended run = RunCommand(
      "/usr/bin/python3 -c 'import resource, subprocess, sys\n"
      "subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)\n"
      "used = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
      "print(used.ru_maxrss, used.ru_utime + used.ru_stime)' " +
      command);
  EXPECT_EQ(run.status, 0) << command << ": " << run.said;
  // Before the figures stands the progress of a long run.
  const std::size_t end_of_progress = run.said.find_last_of('\n', run.said.size() - 2);
  Effort effort;
  std::istringstream(run.said.substr(end_of_progress + 1)) >> effort.memory_kb >> effort.cpu_s;
  return effort;
}

}  // namespace railcast
