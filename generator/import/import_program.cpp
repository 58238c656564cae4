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
std::filesystem::path ImportProgram() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto installed = folder.parent_path() / "libexec/railcast/railcast-import";
  const auto built = folder / "railcast-import";
  for (const std::filesystem::path& program : {built, installed}) {
    if (std::filesystem::exists(program)) return program;
  }
  throw InputError("railcast-generate: import is a program of its own, " + installed.string() +
                   ", which is not installed (Debian package railcast-import)");
}

int RunImportProgram(std::vector<std::string> arguments) {
  const std::filesystem::path program = ImportProgram();
  arguments.insert(arguments.begin(), {"railcast-generate", "import"});
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  throw FileError(program.string(), errno);
}

}  // namespace

void AddImportProgram(ProgramOptions& app, ProgramCommand& command) {
  ProgramOptions subcommand = app.AddForeignCommand("import", kImportDescription);
  // All that follows is for the other program, also what asks for help.
  subcommand.WhenParsed([&command, subcommand] {
    command = [subcommand](const std::string& /*all*/) {
      return RunImportProgram(subcommand.Remaining());
    };
  });
}

}  // namespace railcast
