#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"

namespace {

/// Adds a command of an extra. In a build without it, the command says so.
void AddOfExtra(const std::string& extra,
                const std::string& name,
                railcast::ProgramOptions& app,
                railcast::ProgramCommand& command) {
  const auto& commands = railcast::AnalysisExtras::Get().commands;
  if (const auto found = commands.find(name); found != commands.end()) {
    found->second(app, command);
    return;
  }
  railcast::AddMissingCommand(name, extra, app, command);
}

void AddCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  app.RequireCommand();
  railcast::AddStats(app, command);
  railcast::AddInspect(app, command);
  AddOfExtra("card", "card", app, command);
  railcast::AddCompare(app, command);
  railcast::AddDetect(app, command);
  AddOfExtra("detectors", "evaluate", app, command);
  AddOfExtra("sight", "sight", app, command);
  AddOfExtra("study", "study", app, command);
  AddOfExtra("dossier", "dossier", app, command);
  AddOfExtra("fit", "fit", app, command);
  railcast::AddFrontier(app, command);
  AddOfExtra("preset", "preset", app, command);
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
