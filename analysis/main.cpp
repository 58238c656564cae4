#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "core/base/inputs.h"

namespace {

void AddCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  const auto add_of_extra = [&](const std::string& extra, const std::string& name) {
    railcast::AddExtraCommand(railcast::AnalysisExtras::Get().commands, name, extra, app, command);
  };
  app.RequireCommand();
  railcast::AddStats(app, command);
  railcast::AddInspect(app, command);
  add_of_extra("card", "card");
  railcast::AddCompare(app, command);
  railcast::AddDetect(app, command);
  add_of_extra("detectors", "evaluate");
  add_of_extra("sight", "sight");
  add_of_extra("track", "track");
  add_of_extra("study", "study");
  add_of_extra("dossier", "dossier");
  add_of_extra("fit", "fit");
  railcast::AddFrontier(app, command);
  add_of_extra("preset", "preset");
  railcast::AddReceive(app, command);
  railcast::AddVerify(app, command);
}

}  // namespace

int main(int argc, char** argv) {
  const railcast::Inputs inputs;
  return railcast::ProgramMain(
      {.name = "railcast-analyze",
       .description = "LiDAR simulation for railways: measures and compares point clouds.",
       .footer = "Exit status: 0 success, 1 bad input or failed run, 2 usage.",
       .add = AddCommands},
      argc, argv);
}
