// The program that railcast-generate runs for what works on recordings.
#include <string_view>

#include "core/base/inputs.h"
#include "generator/commands.h"
#include "generator/extras/recording_commands.h"

namespace {

void AddCommandsOfRecordings(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  app.RequireCommand();
  const auto& built = railcast::RecordingCommands::Get().commands;
  for (const railcast::OwnProgram& own : railcast::kOwnPrograms) {
    if (own.program != std::string_view("railcast-recordings")) continue;
    railcast::AddExtraCommand(built, own.command, own.extra, app, command);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const railcast::Inputs inputs;
  return railcast::ProgramMain(
      {.name = "railcast-generate",
       .description = "Puts objects into recordings, converts and "
                      "sends them, and makes scenes and data sets of them.",
       .footer = railcast::kExitStatusText,
       .add = AddCommandsOfRecordings},
      argc, argv);
}
