#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <iostream>

#include "analysis/commands.h"
#include "core/base/error.h"

namespace {

using railcast::FrontierOptions;
using railcast::ReceiveOptions;

void AddFrontier(CLI::App& app, FrontierOptions& options, std::function<int()>& command) {
  CLI::App* frontier = app.add_subcommand(
      "frontier", "Chart time against accuracy: the rungs, brute force, and the reference");
  frontier->add_option("SCENARIO", options.scenario, "Scenario file")->required();
  frontier->add_option("--out", options.out, "Directory for frontier.json, .csv, .svg, .png")
      ->required();
  frontier->add_option("--frames", options.num_frames, "How many sample frames, a second apart")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  frontier->add_option("--threads", options.num_threads, "Of the timing; 0 = all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  frontier->add_option("--sensor", options.sensor, "Which of the scenario's sensors");
  frontier->add_option("--rows", options.rows, "Rows separated by commas, or all")
      ->capture_default_str();
  frontier->callback([&] { command = [&] { return railcast::FrontierCommand(options); }; });
}

void AddReceive(CLI::App& app, ReceiveOptions& options, std::function<int()>& command) {
  CLI::App* receive = app.add_subcommand(
      "receive", "Listen to a live stream: what arrives, and what is lost; until Ctrl-C");
  receive->add_option("HOST:PORT", options.at, "Where to listen; 0.0.0.0 hears other machines, too")
      ->capture_default_str();
  receive->add_option("--duration", options.duration_s, "End after so many seconds")
      ->check(CLI::PositiveNumber);
  receive->add_option("--frames", options.num_frames, "End after so many frames")
      ->check(CLI::PositiveNumber);
  receive->add_option("--out", options.out, "Directory for frames/*.pcd and frames.csv");
  receive->callback([&] { command = [&] { return railcast::ReceiveCommand(options); }; });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("LiDAR simulation for railways: what frames are worth");
  app.set_version_flag("--version", "railcast " RAILCAST_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  app.footer("Exit status: 0 success, 1 bad input or failed run, 2 usage.");
  FrontierOptions frontier;
  ReceiveOptions receive;
  std::function<int()> command;
  AddFrontier(app, frontier, command);
  AddReceive(app, receive, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? railcast::kExitSuccess : railcast::kExitUsage;
  }
  try {
    return command();
  } catch (const railcast::InputError& error) {
    std::cerr << error.what() << "\n";
  } catch (const std::exception& error) {
    std::cerr << "railcast-analyze: " << error.what() << "\n";
  }
  return railcast::kExitFailure;
}
