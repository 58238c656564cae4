#include "generator/run/run_options.h"

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

}  // namespace railcast
