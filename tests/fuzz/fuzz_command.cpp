#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/scenario/command.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

void ReadLine(std::string_view line) {
  const CommandLine read = ReadCommand(line);
  Check(read.command.has_value() == read.faults.empty(), "a line is a command or has a fault");
  Check(read.faults.size() <= 9, "faults are few");
  for (const std::string& fault : read.faults) {
    Check(fault.starts_with("command: ") && fault.size() <= 303, "a fault is short");
    Check(fault.find('\n') == std::string::npos, "a fault is one line");
  }
  if (!read.command) return;
  const std::string written = WriteCommand(*read.command, read.tag);
  Check(written.find('\n') == std::string::npos, "a command is one line");
  const CommandLine again = ReadCommand(written);
  // A short command may become long when all defaults are written.
  if (written.size() > kMaxCommandBytes) return;
  Check(again.faults.empty(), "what is written can be read");
  Check(again.command == read.command && again.tag == read.tag, "and says the same");
}

}  // namespace
}  // namespace railcast

/// a datagram of the command channel, which is also a line of a command
/// log.
RAILCAST_FUZZ_TARGET(command) {
  railcast::ReadLine({reinterpret_cast<const char*>(data), size});
  return 0;
}
