#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "core/base/error.h"

namespace {

/// Adds a command of an extra. In a build without it, the command says so.
void AddOfExtra(const std::string& name,
                railcast::ProgramOptions& app,
                railcast::ProgramCommand& command) {
  const auto& commands = railcast::AnalysisExtras::Get().commands;
  if (const auto found = commands.find(name); found != commands.end()) {
    found->second(app, command);
    return;
  }
  app.AddForeignCommand(name, "Not installed").WhenParsed([&command, name] {
    command = [name](const std::string&) -> int {
      throw railcast::InputError("railcast-analyze: " + name +
                                 " belongs to an extra, which is not installed");
    };
  });
}

void AddCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  app.RequireCommand();
  railcast::AddStats(app, command);
  railcast::AddInspect(app, command);
  AddOfExtra("card", app, command);
  railcast::AddCompare(app, command);
  railcast::AddDetect(app, command);
  AddOfExtra("evaluate", app, command);
  AddOfExtra("sight", app, command);
  AddOfExtra("study", app, command);
  AddOfExtra("dossier", app, command);
  AddOfExtra("fit", app, command);
  railcast::AddFrontier(app, command);
  AddOfExtra("preset", app, command);
  railcast::AddReceive(app, command);
  railcast::AddVerify(app, command);
}

}  // namespace

int main(int argc, char** argv) {
  return railcast::ProgramMain(
      {.name = "railcast-analyze",
       .description = "LiDAR simulation for railways: measures and compares point clouds.",
       .footer = "Exit status: 0 success, 1 bad input or failed run, 2 usage.",
       .add = AddCommands},
      argc, argv);
}
