#include "generator/commands.h"

#include <initializer_list>
#include <string>

#include "core/base/error.h"
#include "core/base/inputs.h"

namespace {

#ifdef RAILCAST_SEQUENCE_ALONE

/// The commands that are not built yet say how they come.
void AddOtherCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  for (const std::string name : {"insert", "convert", "stream", "replay", "check", "world", "trace",
                                 "dataset", "merge", "survey", "import"}) {
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
  using railcast::OwnProgramOf;
  const auto add_own = [&](std::initializer_list<railcast::OwnProgram> programs) {
    for (const railcast::OwnProgram& own : programs) railcast::AddOwnProgram(own, app, command);
  };
  add_own({OwnProgramOf("insert"), OwnProgramOf("convert")});
  railcast::AddStream(app, command);
  add_own({OwnProgramOf("replay")});
  railcast::AddCheck(app, command);
  railcast::AddWorld(app, command);
  railcast::AddTrace(app, command);
  add_own({OwnProgramOf("dataset"), OwnProgramOf("merge"), OwnProgramOf("survey"),
           OwnProgramOf("import")});
}

#endif

void AddCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  app.RequireCommand();
  railcast::AddSequence(app, command);
  AddOtherCommands(app, command);
}

}  // namespace

int main(int argc, char** argv) {
  const railcast::Inputs inputs;
  return railcast::ProgramMain(
      {.name = "railcast-generate",
       .description = "LiDAR simulation for railways: makes frames from a scenario.",
       .footer = railcast::kExitStatusText,
       .add = AddCommands},
      argc, argv);
}
