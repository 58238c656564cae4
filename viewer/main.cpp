#include <memory>

#include "core/program/program.h"
#include "railcast/error.h"
#include "viewer/gui/gui.h"
#include "viewer/options.h"
#include "viewer/run.h"

namespace railcast {
namespace {

int RunView(const ViewOptions& options) {
  try {
    RunViewer(options);
  } catch (const InputError& error) {
    throw InputError(std::string("error: ") + error.what());
  }
  return kExitSuccess;
}

void AddView(CLI::App& app, ProgramCommand& command) {
  const auto options = std::make_shared<ViewOptions>();
  AddViewOptions(app, *options);
  command = [options](const std::string&) { return RunView(*options); };
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::ProgramMain(
      {.name = "railcast-view",
       .description = "Shows point clouds, recorded or live, and what is known of them.",
       .footer = "Keys in the window:\n" + railcast::Gui::KeysText(),
       .add = railcast::AddView},
      argc, argv);
}
