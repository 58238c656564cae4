// railcast-measure: measures what scenes cost. Its commands share what builds and times scenarios.
#include "tests/bench/measurements.h"

namespace {

void AddCommands(railcast::ProgramOptions& app, railcast::ProgramCommand& command) {
  app.RequireCommand();
  railcast::AddScaling(app, command);
  railcast::AddStages(app, command);
  railcast::AddRebuild(app, command);
  railcast::AddDetail(app, command);
  railcast::AddMeshes(app, command);
  railcast::AddModules(app, command);
  railcast::AddSettings(app, command);
}

}  // namespace

int main(int argc, char** argv) {
  return railcast::ProgramMain(
      {"railcast-measure", "Measures what scenes and their frames cost.", "", AddCommands}, argc,
      argv);
}
