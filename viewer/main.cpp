#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>

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
    constexpr int kExitUsage = 2;
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  try {
    RunViewer(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::RunProgram([&] { return railcast::Main(argc, argv); }, std::cerr);
}
