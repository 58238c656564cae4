#include "core/program/program.h"

#include <iostream>

#include "core/program/command_line.h"
#include "core/program/run_program.h"
#include "core/program/shell_word.h"
#include "core/program/version.h"

namespace railcast {
namespace {

// Returns the line as a shell would read it, with the program's path reduced to its name.
std::string CommandLine(const std::string& program, int argc, char** argv) {
  std::string line = program;
  for (int i = 1; i < argc; ++i) {
    line += " ";
    line += ShellWord(argv[i]);
  }
  return line;
}

int ParseAndRun(const ProgramSpec& spec, int argc, char** argv) {
  CLI::App app(spec.description, spec.name);
  app.set_version_flag("--version", "railcast " + ProgramVersion());
  app.failure_message(SayWhatIsWrong);
  app.footer(spec.footer);
  ProgramCommand command;
  spec.add(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitSuccess : kExitUsage;
  }
  return command(CommandLine(spec.name, argc, argv));
}

}  // namespace

int ProgramMain(const ProgramSpec& spec, int argc, char** argv) {
  return RunProgram(
      spec.name, [&] { return ParseAndRun(spec, argc, argv); }, std::cerr);
}

}  // namespace railcast
