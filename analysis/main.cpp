#include <pcl/console/print.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <string>

#include "analysis/commands.h"
#include "analysis/shell_word.h"
#include "core/base/error.h"
#include "core/io/command_line.h"
#include "core/io/run_program.h"
#include "core/io/version.h"

namespace {

// As a shell reads it; the program by its name alone.
std::string CommandLine(int argc, char** argv) {
  std::string line = "railcast-analyze";
  for (int i = 1; i < argc; ++i) {
    line += " ";
    line += railcast::ShellWord(argv[i]);
  }
  return line;
}

int Main(int argc, char** argv) {
  // What PCL says of single neighbourhoods is no news: what matters is in the figures.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  CLI::App app("LiDAR simulation for railways: measures and compares point clouds.");
  app.set_version_flag("--version", "railcast " + railcast::ProgramVersion());
  app.require_subcommand(1);
  app.failure_message(railcast::SayWhatIsWrong);
  app.fallthrough();
  app.footer("Exit status: 0 success, 1 bad input or failed run, 2 usage.");
  railcast::Command command;
  railcast::AddStats(app, command);
  railcast::AddCompare(app, command);
  railcast::AddDetect(app, command);
  railcast::AddFit(app, command);
  railcast::AddFrontier(app, command);
  railcast::AddReceive(app, command);
  railcast::AddVerify(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? railcast::kExitSuccess : railcast::kExitUsage;
  }
  return command(CommandLine(argc, argv));
}

}  // namespace

int main(int argc, char** argv) {
  return railcast::RunProgram(
      "railcast-analyze", [&] { return Main(argc, argv); }, std::cerr);
}
