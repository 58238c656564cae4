#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/write_file.h"
#include "generator/commands.h"

namespace railcast {
namespace {

/// Beside railcast-generate in a build, below libexec where they are installed.
std::filesystem::path FindProgram(const OwnProgram& own) {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto installed = folder.parent_path() / "libexec/railcast" / own.program;
  const auto built = folder / own.program;
  for (const std::filesystem::path& program : {built, installed}) {
    if (std::filesystem::exists(program)) return program;
  }
  throw LacksExtra(std::string("railcast-generate ") + own.command, own.extra);
}

/// @param arguments What follows the command.
int RunProgramOf(const OwnProgram& own, std::vector<std::string> arguments) {
  const std::filesystem::path program = FindProgram(own);
  arguments.insert(arguments.begin(), {"railcast-generate", own.command});
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  throw FileError(program.string(), errno);
}

}  // namespace

void AddOwnProgram(const OwnProgram& own, ProgramOptions& app, ProgramCommand& command) {
  ProgramOptions subcommand = app.AddForeignCommand(own.command, own.description);
  // All that follows is for the other program, also what asks for help.
  subcommand.WhenParsed([&command, own, subcommand] {
    command = [own, subcommand](const std::string& /*all*/) {
      return RunProgramOf(own, subcommand.Remaining());
    };
  });
}

}  // namespace railcast
