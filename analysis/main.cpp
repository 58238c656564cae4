#include "analysis/commands.h"

namespace {

void AddCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  app.RequireCommand();
  railcast::AddStats(app, command);
  railcast::AddInspect(app, command);
  railcast::AddCard(app, command);
  railcast::AddCompare(app, command);
  railcast::AddDetect(app, command);
  railcast::AddEvaluate(app, command);
  railcast::AddSight(app, command);
  railcast::AddStudy(app, command);
  railcast::AddDossier(app, command);
  railcast::AddFit(app, command);
  railcast::AddFrontier(app, command);
  railcast::AddPreset(app, command);
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
