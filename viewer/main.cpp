#include <CLI/CLI.hpp>
#include <iostream>
#include <string>

#include "core/base/error.h"
#include "core/io/run_program.h"
#include "viewer/options.h"
#include "viewer/run.h"

namespace railcast {
namespace {

int Main(int argc, char** argv) {
  CLI::App app("Shows point clouds, recorded or live, and what is known of them.", "railcast-view");
  ViewOptions options;
  try {
    options = ParseOptions(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitSuccess : kExitUsage;
  }
  try {
    RunViewer(options);
  } catch (const InputError& error) {
    throw InputError(std::string("error: ") + error.what());
  }
  return kExitSuccess;
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::RunProgram(
      "railcast-view", [&] { return railcast::Main(argc, argv); }, std::cerr);
}
