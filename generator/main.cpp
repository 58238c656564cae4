#include "generator/commands.h"

namespace {

void AddCommands(CLI::App& app, railcast::ProgramCommand& command) {
  app.require_subcommand(1);
  app.fallthrough();
  app.add_flag("-v,--verbose")->description("Print details of each step");
  railcast::AddSequence(app, command);
  railcast::AddInsert(app, command);
  railcast::AddStream(app, command);
  railcast::AddReplay(app, command);
  railcast::AddCheck(app, command);
  railcast::AddWorld(app, command);
  railcast::AddTrace(app, command);
  railcast::AddDataset(app, command);
  railcast::AddMerge(app, command);
  railcast::AddSurvey(app, command);
#ifdef RAILCAST_HAS_IMPORT
  railcast::AddImportProgram(app, command);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  return railcast::ProgramMain(
      {.name = "railcast-generate",
       .description = "LiDAR simulation for railways: makes frames from a scenario.",
       .footer = railcast::kExitStatusText,
       .add = AddCommands},
      argc, argv);
}
