#include "generator/commands.h"

#include <string>

#include "core/base/error.h"

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
  // What works on recordings is linked with PCL.
  const auto add_of_recordings = [&](const std::string& name, const std::string& description) {
    railcast::AddOwnProgram({name, description, "railcast-recordings", "railcast"}, app, command);
  };
  add_of_recordings("insert", railcast::kInsertDescription);
  add_of_recordings("convert", railcast::kConvertDescription);
  railcast::AddStream(app, command);
  add_of_recordings("replay", railcast::kReplayDescription);
  railcast::AddCheck(app, command);
  railcast::AddWorld(app, command);
  railcast::AddTrace(app, command);
  add_of_recordings("dataset", railcast::kDatasetDescription);
  add_of_recordings("merge", railcast::kMergeDescription);
  add_of_recordings("survey", railcast::kSurveyDescription);
#ifdef RAILCAST_HAS_IMPORT
  // GDAL, with all that it can read, takes a tenth of a second to load.
  railcast::AddOwnProgram(
      {"import", railcast::kImportDescription, "railcast-import", "railcast-import"}, app, command);
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
