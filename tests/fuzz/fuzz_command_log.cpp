#include <cstdint>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/scenario/command_log.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

CommandLog Parse(const std::string& text) {
  std::istringstream stream(text);
  return ParseCommandLog(stream, "fuzz");
}

void CheckTimes(const CommandLog& log) {
  std::int64_t last_ns = 0;
  for (const TimedCommand& command : log.commands) {
    Check(command.time_ns >= last_ns, "times rise");
    Check(!std::holds_alternative<Reset>(command.command) &&
              !std::holds_alternative<Step>(command.command),
          "a command shapes frames");
    last_ns = command.time_ns;
  }
}

void ReadLog(const std::string& text) {
  try {
    const CommandLog log = Parse(text);
    CheckTimes(log);
    const std::string written = CommandLogText(log);
    const CommandLog again = Parse(written);
    Check(again == log, "what is written reads the same");
    Check(CommandLogText(again) == written, "and is written the same");
  } catch (const InputError& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) {
      Check(line.starts_with("fuzz: "), "a fault names its file");
    }
  }
}

}  // namespace
}  // namespace railcast

/// a command log.
RAILCAST_FUZZ_TARGET(command_log) {
  railcast::ReadLog({reinterpret_cast<const char*>(data), size});
  return 0;
}
