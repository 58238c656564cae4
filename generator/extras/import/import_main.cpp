// The program that `railcast-generate import` runs.
#include "generator/extras/commands.h"

namespace {

void AddCommand(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  app.RequireCommand();
  railcast::AddImport(app, command);
}

}  // namespace

int main(int argc, char** argv) {
  return railcast::ProgramMain({.name = "railcast-generate",
                                .description = "Makes railcast's alignments and worlds from maps.",
                                .footer = railcast::kExitStatusText,
                                .add = AddCommand},
                               argc, argv);
}
