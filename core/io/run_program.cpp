#include "core/io/run_program.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>

#include "core/io/write_file.h"

namespace railcast {
namespace {

// The lowest free number is what open() gives. Writing to a stdout that was closed must still fail.
void TakeClosedStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    (void)::open("/dev/null", stream == STDOUT_FILENO ? O_RDONLY : O_RDWR);
  }
}

}  // namespace

int RunProgram(const std::function<int()>& main, std::ostream& complaints) {
  TakeClosedStreams();
  const int status = main();
  errno = 0;
  std::cout.flush();
  std::fflush(stdout);
  if (std::cout.good() && std::ferror(stdout) == 0) return status;
  // What was refused long ago and is held no more has no reason left to be told.
  complaints << (errno != 0 ? FileError("stdout", errno).what()
                            : "stdout: not all of it could be written")
             << "\n";
  return status != 0 ? status : 1;
}

}  // namespace railcast
