#include "generator/run/run_options.h"

#include "core/base/text.h"
#include "core/trace/trace_program.h"
#include "railcast/error.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

void AddIsa(CLI::App& command, std::string& isa) {
  command
      .add_option("--isa", isa,
                  "Instruction set for ray tracing, on which the last bits of ranges depend; "
                  "default: the machine's best")
      ->check(CLI::IsMember(IsaNames()));
}

void CheckFields(const std::string& fields) {
  try {
    static_cast<void>(FieldSelection(fields));
  } catch (const InputError& error) {
    throw CLI::ValidationError(error.what());
  }
}

void CheckHasStamp(const std::string& option, const ScanPattern& pattern, std::uint32_t frame) {
  if (frame <= pattern.LastFrame()) return;
  std::string line = option;
  line.append(": must lead to no frame after ").append(std::to_string(pattern.LastFrame()));
  line.append(", since the next begins after 292 years at ").append(NumberText(pattern.rate_hz));
  line.append(" Hz (got frame ").append(std::to_string(frame)).append(")");
  throw InputError(line);
}

}  // namespace railcast
