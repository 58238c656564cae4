#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "generator/commands.h"

namespace railcast {
namespace {

int RunImportProgram(std::vector<std::string> arguments) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "railcast-import";
  arguments.insert(arguments.begin(), {"railcast-generate", "import"});
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  throw FileError(program.string(), errno);
}

}  // namespace

void AddImportProgram(CLI::App& app, ProgramCommand& command) {
  CLI::App* subcommand = app.add_subcommand("import", kImportDescription);
  // All that follows is for the other program, also what asks for help.
  subcommand->prefix_command()->fallthrough(false)->set_help_flag();
  subcommand->callback([&command, subcommand] {
    command = [subcommand](const std::string& /*all*/) {
      return RunImportProgram(subcommand->remaining());
    };
  });
}

}  // namespace railcast
