// The program that railcast-generate runs for what works on recordings.
#include "generator/extras/commands.h"

namespace {

void AddCommandsOfRecordings(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  app.RequireCommand();
  app.AddFlag("-v,--verbose", "Print details of each step");
  railcast::AddInsert(app, command);
  railcast::AddConvert(app, command);
  railcast::AddReplay(app, command);
  railcast::AddDataset(app, command);
  railcast::AddMerge(app, command);
  railcast::AddSurvey(app, command);
}

}  // namespace

int main(int argc, char** argv) {
  return railcast::ProgramMain(
      {.name = "railcast-generate",
       .description = "Puts objects into recordings, converts and "
                      "sends them, and makes scenes and data sets of them.",
       .footer = railcast::kExitStatusText,
       .add = AddCommandsOfRecordings},
      argc, argv);
}
