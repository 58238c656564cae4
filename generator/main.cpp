#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/command_line.h"
#include "core/io/field_selection.h"
#include "core/io/run_program.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario.h"
#include "generator/commands.h"

namespace {

using railcast::CheckOptions;
using railcast::NonEmpty;
using railcast::Number;
using railcast::SequenceOptions;
using railcast::StreamOptions;
using railcast::TraceOptions;
using railcast::Whole;
using railcast::WorldOptions;

constexpr std::uint64_t kMaxFrame = 1'000'000'000;
constexpr railcast::NumberRule kChainage{-1e7, 1e7};  // In m.

// What is no list of fields is wrong usage, as what is no format.
void CheckFields(const std::string& fields) {
  try {
    static_cast<void>(railcast::FieldSelection(fields));
  } catch (const railcast::InputError& error) {
    throw CLI::ValidationError(error.what());
  }
}

void AddSequence(CLI::App& app, SequenceOptions& options, std::function<int()>& command) {
  CLI::App* sequence = app.add_subcommand(
      "sequence", "Make labelled frames; the same command again continues an interrupted run");
  sequence->add_option("SCENARIO", options.scenario, "Scenario file")
      ->required()
      ->check(NonEmpty());
  sequence->add_option("--out", options.out, "Directory for the frames")
      ->required()
      ->check(NonEmpty());
  sequence->add_option("--frames", options.num_frames, "How many frames")
      ->transform(Whole({1, kMaxFrame}))
      ->capture_default_str();
  sequence->add_option("--start-frame", options.start_frame, "Number of the first")
      ->transform(Whole({0, kMaxFrame}))
      ->capture_default_str();
  sequence
      ->add_option("--format", options.format,
                   "pcd, pcd-compressed, pcd-ascii, ply, ply-cloudcompare or kitti")
      ->check(
          CLI::IsMember({"pcd", "pcd-compressed", "pcd-ascii", "ply", "ply-cloudcompare", "kitti"}))
      ->capture_default_str();
  sequence->add_option("--fields", options.fields, "Fields separated by commas, or all")
      ->capture_default_str();
  sequence->add_option("--seed", options.seed, "Instead of the scenario's")->transform(Whole({}));
  sequence->add_option("--threads", options.num_threads, "0 = all cores")
      ->transform(Whole({0, 1024}))
      ->capture_default_str();
  sequence->add_option("--fidelity", options.fidelity, "Instead of the scenario's")
      ->check(CLI::IsMember(railcast::FidelityNames()));
  sequence->add_option("--sensor", options.sensor, "Which of the scenario's sensors");
  sequence
      ->add_option("--commands", options.commands,
                   "Replay this log of a live run: same scenario, same frames")
      ->check(NonEmpty());
  sequence->callback([&] {
    CheckFields(options.fields);
    command = [&] { return railcast::SequenceCommand(options); };
  });
}

void AddStream(CLI::App& app, StreamOptions& options, std::function<int()>& command) {
  CLI::App* stream = app.add_subcommand(
      "stream", "Send frames over UDP as they would come from real sensors, until Ctrl-C");
  stream->add_option("SCENARIO", options.scenario, "Scenario file")->required()->check(NonEmpty());
  stream->add_option("--sensor", options.sensor, "This one of several; default: all");
  stream
      ->add_option("--to", options.to,
                   "HOST:PORT of a receiver, repeated for several; default: the scenario's, else "
                   "this machine. Everybody on the network is 255.255.255.255")
      ->allow_extra_args(false);
  stream->add_option("--protocol", options.protocol, "Instead of the scenario's")
      ->check(CLI::IsMember(railcast::ProtocolNames()));
  stream->add_option("--fields", options.fields,
                     "Protocol railcast: fields separated by commas, or all; default: "
                     "x,y,z,intensity,ring,time_ns,label,instance");
  stream->add_flag("--all-slots", options.has_all_slots,
                   "Protocol railcast: also what did not return");
  stream
      ->add_option("--pacing", options.pacing,
                   "spread: each datagram when its last firing is; burst: a frame at once")
      ->check(CLI::IsMember({"spread", "burst"}))
      ->capture_default_str();
  stream
      ->add_option("--pcap", options.pcap,
                   "Capture file to write; without --to nothing is sent, and it is written as "
                   "fast as it can be made")
      ->check(NonEmpty());
  stream
      ->add_option("--calibration", options.calibration,
                   "Protocol hdl64e: calibration file to write for receivers")
      ->check(NonEmpty());
  stream
      ->add_option("--commands-port", options.commands_port,
                   "UDP port where commands are heard, JSON lines; default: none are")
      ->transform(Whole({1, 65535}));
  stream->add_option("--commands-from", options.commands_from,
                     "HOST or HOST:PORT whose commands are heard; default: this machine");
  stream
      ->add_option("--commands-log", options.commands_log,
                   "File to write for `sequence --commands`")
      ->check(NonEmpty());
  stream->add_flag("--lockstep", options.lockstep, "Each frame waits for command step");
  stream->add_option("--duration", options.duration_s, "Seconds of simulation; default: no end")
      ->check(Number({1e-3, 1e9}));
  stream->add_option("--seed", options.seed, "Instead of the scenario's")->transform(Whole({}));
  stream->add_option("--threads", options.num_threads, "0 = all cores")
      ->transform(Whole({0, 1024}))
      ->capture_default_str();
  stream->add_option("--fidelity", options.fidelity, "Instead of the scenario's")
      ->check(CLI::IsMember(railcast::FidelityNames()));
  stream->callback([&] {
    if (options.fields) CheckFields(*options.fields);
    command = [&] { return railcast::StreamCommand(options); };
  });
}

void AddCheck(CLI::App& app, CheckOptions& options, std::function<int()>& command) {
  CLI::App* check = app.add_subcommand(
      "check",
      "Report every error of a scenario, or what follows from it and what its scene holds");
  check->add_option("SCENARIO", options.scenario, "Scenario file")->required()->check(NonEmpty());
  check
      ->add_option("--resolved", options.resolved,
                   "File for the scenario with every default and included file in place; - writes "
                   "it, and nothing else, to stdout")
      ->check(NonEmpty());
  check->callback([&] { command = [&] { return railcast::CheckCommand(options); }; });
}

void AddWorld(CLI::App& app, WorldOptions& options, std::function<int()>& command) {
  CLI::App* world = app.add_subcommand("world", "Write the scene as triangles");
  world->add_option("SCENARIO", options.scenario, "Scenario file")->required()->check(NonEmpty());
  world->add_option("--out", options.out, "File to write: *.ply or *.obj")
      ->required()
      ->check(NonEmpty());
  world->add_option("--from-s", options.from_s_m, "Chainage in m; default: the window of frame 0")
      ->check(Number(kChainage));
  world->add_option("--to-s", options.to_s_m, "Chainage in m")->check(Number(kChainage));
  world->callback([&] { command = [&] { return railcast::WorldCommand(options); }; });
}

void AddTrace(CLI::App& app, TraceOptions& options, std::function<int()>& command) {
  CLI::App* trace = app.add_subcommand("trace", "Replay one firing and print each effect's doing");
  trace->add_option("SCENARIO", options.scenario, "Scenario file")->required()->check(NonEmpty());
  trace->add_option("--sensor", options.sensor, "Which of the scenario's sensors");
  trace->add_option("--frame", options.frame, "Number of the frame")
      ->transform(Whole({0, kMaxFrame}))
      ->capture_default_str();
  trace->add_option("--firing", options.firing, "Number of the firing in the order of time")
      ->required()
      ->transform(Whole({0, kMaxFrame}));
  trace->callback([&] { command = [&] { return railcast::TraceCommand(options); }; });
}

int Main(int argc, char** argv) {
  CLI::App app("LiDAR simulation for railways: frames from a scenario");
  app.set_version_flag("--version", "railcast " RAILCAST_VERSION);
  app.require_subcommand(1);
  app.failure_message(railcast::SayWhatIsWrong);
  app.fallthrough();
  app.footer(
      "Exit status: 0 success, 1 bad input or failed run, 2 usage, 130 interrupted (the same\n"
      "command continues).");
  bool is_verbose = false;
  app.add_flag("-v,--verbose", is_verbose, "Say more");
  SequenceOptions sequence;
  StreamOptions stream;
  CheckOptions check;
  WorldOptions world;
  TraceOptions trace;
  std::function<int()> command;
  AddSequence(app, sequence, command);
  AddStream(app, stream, command);
  AddCheck(app, check, command);
  AddWorld(app, world, command);
  AddTrace(app, trace, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? railcast::kExitSuccess : railcast::kExitUsage;
  }
  sequence.is_verbose = check.is_verbose = world.is_verbose = is_verbose;
  return command();
}

}  // namespace

int main(int argc, char** argv) {
  return railcast::RunProgram(
      "railcast-generate", [&] { return Main(argc, argv); }, std::cerr);
}
