#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <iostream>

#include "core/base/error.h"
#include "core/scenario/effects.h"
#include "generator/commands.h"

namespace {

using railcast::CheckOptions;
using railcast::SequenceOptions;
using railcast::TraceOptions;
using railcast::WorldOptions;

void AddSequence(CLI::App& app, SequenceOptions& options, std::function<int()>& command) {
  CLI::App* sequence = app.add_subcommand(
      "sequence", "Make labelled frames; the same command again continues an interrupted run");
  sequence->add_option("SCENARIO", options.scenario, "Scenario file")->required();
  sequence->add_option("--out", options.out, "Directory for the frames")->required();
  sequence->add_option("--frames", options.num_frames, "How many frames")
      ->check(CLI::Range(1, 1'000'000'000))
      ->capture_default_str();
  sequence->add_option("--start-frame", options.start_frame, "Number of the first")
      ->check(CLI::Range(0, 1'000'000'000))
      ->capture_default_str();
  sequence
      ->add_option("--format", options.format,
                   "pcd, pcd-compressed, pcd-ascii, ply, ply-cloudcompare or kitti")
      ->check(
          CLI::IsMember({"pcd", "pcd-compressed", "pcd-ascii", "ply", "ply-cloudcompare", "kitti"}))
      ->capture_default_str();
  sequence->add_option("--fields", options.fields, "Fields separated by commas, or all")
      ->capture_default_str();
  sequence->add_option("--seed", options.seed, "Instead of the scenario's");
  sequence->add_option("--threads", options.num_threads, "0 = all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  sequence->add_option("--fidelity", options.fidelity, "Instead of the scenario's")
      ->check(CLI::IsMember(railcast::FidelityNames()));
  sequence->add_option("--sensor", options.sensor, "Which of the scenario's sensors");
  sequence->add_option("--commands", options.commands,
                       "Replay this log of a live run: same scenario, same frames");
  sequence->callback([&] { command = [&] { return railcast::SequenceCommand(options); }; });
}

void AddCheck(CLI::App& app, CheckOptions& options, std::function<int()>& command) {
  CLI::App* check = app.add_subcommand(
      "check",
      "Report every error of a scenario, or what follows from it and what its scene holds");
  check->add_option("SCENARIO", options.scenario, "Scenario file")->required();
  check->add_option("--resolved", options.resolved,
                    "File for the scenario with every default and included file in place; - writes "
                    "it, and nothing else, to stdout");
  check->callback([&] { command = [&] { return railcast::CheckCommand(options); }; });
}

void AddWorld(CLI::App& app, WorldOptions& options, std::function<int()>& command) {
  CLI::App* world = app.add_subcommand("world", "Write the scene as triangles");
  world->add_option("SCENARIO", options.scenario, "Scenario file")->required();
  world->add_option("--out", options.out, "File to write: *.ply or *.obj")->required();
  world->add_option("--from-s", options.from_s_m, "Chainage in m; default: the window of frame 0");
  world->add_option("--to-s", options.to_s_m, "Chainage in m");
  world->callback([&] { command = [&] { return railcast::WorldCommand(options); }; });
}

void AddTrace(CLI::App& app, TraceOptions& options, std::function<int()>& command) {
  CLI::App* trace = app.add_subcommand("trace", "Replay one firing and print each effect's doing");
  trace->add_option("SCENARIO", options.scenario, "Scenario file")->required();
  trace->add_option("--sensor", options.sensor, "Which of the scenario's sensors");
  trace->add_option("--frame", options.frame, "Number of the frame")
      ->check(CLI::Range(0, 1'000'000'000))
      ->capture_default_str();
  trace->add_option("--firing", options.firing, "Number of the firing in the order of time")
      ->required()
      ->check(CLI::Range(0, 1'000'000'000));
  trace->callback([&] { command = [&] { return railcast::TraceCommand(options); }; });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("LiDAR simulation for railways: frames from a scenario");
  app.set_version_flag("--version", "railcast " RAILCAST_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  app.footer(
      "Exit status: 0 success, 1 bad input or failed run, 2 usage, 130 interrupted (the same\n"
      "command continues).");
  bool is_verbose = false;
  app.add_flag("-v,--verbose", is_verbose, "Say more");
  SequenceOptions sequence;
  CheckOptions check;
  WorldOptions world;
  TraceOptions trace;
  std::function<int()> command;
  AddSequence(app, sequence, command);
  AddCheck(app, check, command);
  AddWorld(app, world, command);
  AddTrace(app, trace, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? railcast::kExitSuccess : railcast::kExitUsage;
  }
  sequence.is_verbose = check.is_verbose = world.is_verbose = is_verbose;
  try {
    return command();
  } catch (const railcast::InputError& error) {
    std::cerr << error.what() << "\n";
  } catch (const std::exception& error) {
    std::cerr << "railcast-generate: " << error.what() << "\n";
  }
  return railcast::kExitFailure;
}
