#include "generator/commands.h"

#include <string>

#include "core/base/error.h"

namespace {

#ifdef RAILCAST_FIRST_STAGE

/// The commands that are not built yet say how they come.
void AddOtherCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  for (const std::string name : {"insert", "stream", "replay", "check", "world", "trace", "dataset",
                                 "merge", "survey", "import"}) {
    railcast::ProgramOptions subcommand = app.AddForeignCommand(name, "Not built yet");
    subcommand.WhenParsed([&command, name] {
      command = [name](const std::string&) -> int {
        throw railcast::InputError("railcast-generate: " + name +
                                   " is not built yet: scripts/build.sh builds all commands");
      };
    });
  }
}

#else

void AddOtherCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
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

#endif

void AddCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  app.RequireCommand();
  app.AddFlag("-v,--verbose", "Print details of each step");
  railcast::AddSequence(app, command);
  AddOtherCommands(app, command);
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
