#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/command_line.h"
#include "core/io/field_selection.h"
#include "core/io/run_program.h"
#include "core/io/version.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario.h"
#include "core/trace/trace_program.h"
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

void AddIsa(CLI::App& command, std::string& isa) {
  command
      .add_option("--isa", isa,
                  "Instruction set that the trace uses; default: the machine's best. The last bits "
                  "of ranges depend on it")
      ->check(CLI::IsMember(railcast::IsaNames()));
}

void AddSequence(CLI::App& app, SequenceOptions& options, std::function<int()>& command) {
  CLI::App* sequence = app.add_subcommand(
      "sequence",
      "Write labelled frames to files; the same command again continues an interrupted run");
  sequence->add_option("SCENARIO", options.scenario, "Scenario file")
      ->required()
      ->check(NonEmpty());
  sequence->add_option("--out", options.out, "Directory to write the frames to")
      ->required()
      ->check(NonEmpty());
  sequence->add_option("--frames", options.num_frames, "How many frames to make")
      ->transform(Whole({1, kMaxFrame}))
      ->capture_default_str();
  sequence->add_option("--start-frame", options.start_frame, "Number of the first frame")
      ->transform(Whole({0, kMaxFrame}))
      ->capture_default_str();
  sequence->add_option("--format", options.format, "File format of the frames")
      ->check(
          CLI::IsMember({"pcd", "pcd-compressed", "pcd-ascii", "ply", "ply-cloudcompare", "kitti"}))
      ->capture_default_str();
  sequence->add_option("--fields", options.fields, "Fields to write, separated by commas, or all")
      ->capture_default_str();
  sequence->add_option("--seed", options.seed, "Seed to use instead of the scenario's")
      ->transform(Whole({}));
  sequence->add_option("--threads", options.num_threads, "Number of threads; 0 = all cores")
      ->transform(Whole({0, 1024}))
      ->capture_default_str();
  sequence->add_option("--fidelity", options.fidelity, "Fidelity to use instead of the scenario's")
      ->check(CLI::IsMember(railcast::FidelityNames()));
  AddIsa(*sequence, options.isa);
  sequence->add_option("--sensor", options.sensor,
                       "Name of the sensor to simulate, where the scenario has several");
  sequence
      ->add_option(
          "--commands", options.commands,
          "Command log of a live run to replay; with the run's scenario it gives the run's frames")
      ->check(NonEmpty());
  sequence->footer(
      "Exit status: 0 success, 1 bad input or failed run, 2 usage, 130 interrupted (the same\n"
      "command continues).");
  sequence->callback([&] {
    CheckFields(options.fields);
    command = [&] { return railcast::SequenceCommand(options); };
  });
}

void AddStream(CLI::App& app, StreamOptions& options, std::function<int()>& command) {
  CLI::App* stream = app.add_subcommand(
      "stream", "Send frames over UDP, as real sensors send theirs, until Ctrl-C");
  stream->add_option("SCENARIO", options.scenario, "Scenario file")->required()->check(NonEmpty());
  stream->add_option(
      "--sensor", options.sensor,
      "Name of the only sensor to stream, where the scenario has several; default: all");
  stream
      ->add_option(
          "--to", options.to,
          "A receiver, HOST:PORT; repeat the option for several. 255.255.255.255 is everybody "
          "on the network. Default: the scenario's receivers, else this machine")
      ->allow_extra_args(false);
  stream->add_option("--protocol", options.protocol, "Protocol to use instead of the scenario's")
      ->check(CLI::IsMember(railcast::ProtocolNames()));
  stream->add_option(
      "--fields", options.fields,
      "With protocol railcast: fields to send, separated by commas, or all; default: "
      "x,y,z,intensity,ring,time_ns,label,instance");
  stream->add_flag("--all-slots", options.has_all_slots,
                   "With protocol railcast: send firings that brought nothing back, too");
  stream
      ->add_option(
          "--pacing", options.pacing,
          "spread: each datagram leaves one period after its last firing, as from a sensor; "
          "burst: all of a frame leave at once")
      ->check(CLI::IsMember({"spread", "burst"}))
      ->capture_default_str();
  stream->add_flag("--drop-late", options.drops_late,
                   "Leave out frames that cannot be in time, whole; default: all are sent, late");
  stream->add_flag(
      "--no-offload", options.sends_singly,
      "Send datagrams one by one, without UDP segmentation offload, so that captures on "
      "this machine hold single datagrams");
  stream
      ->add_option(
          "--pcap", options.pcap,
          "Capture file to write. Without --to nothing is sent, and the file is made as fast "
          "as the machine can")
      ->check(NonEmpty());
  stream
      ->add_option("--calibration", options.calibration,
                   "With protocol hdl64e: calibration file to write, which receivers need")
      ->check(NonEmpty());
  stream
      ->add_option("--commands-port", options.commands_port,
                   "UDP port at which commands are heard, as lines of JSON; default: none")
      ->transform(Whole({1, 65535}));
  stream->add_option("--commands-from", options.commands_from,
                     "HOST or HOST:PORT from which commands are heard; default: this machine only");
  stream
      ->add_option("--commands-log", options.commands_log,
                   "File to log the commands to, for `sequence --commands`")
      ->check(NonEmpty());
  stream->add_flag("--lockstep", options.lockstep, "Wait for the command `step` before each frame");
  stream
      ->add_option("--duration", options.duration_s,
                   "Seconds of simulation after which to end; default: no end")
      ->check(Number({1e-3, 1e9}));
  stream->add_option("--seed", options.seed, "Seed to use instead of the scenario's")
      ->transform(Whole({}));
  stream->add_option("--threads", options.num_threads, "Number of threads; 0 = all cores")
      ->transform(Whole({0, 1024}))
      ->capture_default_str();
  stream->add_option("--fidelity", options.fidelity, "Fidelity to use instead of the scenario's")
      ->check(CLI::IsMember(railcast::FidelityNames()));
  AddIsa(*stream, options.isa);
  stream->callback([&] {
    if (options.fields) CheckFields(*options.fields);
    command = [&] { return railcast::StreamCommand(options); };
  });
}

void AddCheck(CLI::App& app, CheckOptions& options, std::function<int()>& command) {
  CLI::App* check = app.add_subcommand("check",
                                       "Report every fault of a scenario or, if it has none, what "
                                       "its scene holds and the sensor sees");
  check->add_option("SCENARIO", options.scenario, "Scenario file")->required()->check(NonEmpty());
  check
      ->add_option(
          "--resolved", options.resolved,
          "File to write the scenario to, with every default and included file in place; - is "
          "stdout, which then gets nothing else")
      ->check(NonEmpty());
  check->callback([&] { command = [&] { return railcast::CheckCommand(options); }; });
}

void AddWorld(CLI::App& app, WorldOptions& options, std::function<int()>& command) {
  CLI::App* world = app.add_subcommand("world", "Write the scene as a mesh of triangles");
  world->add_option("SCENARIO", options.scenario, "Scenario file")->required()->check(NonEmpty());
  world->add_option("--out", options.out, "File to write; its name ends in .ply or .obj")
      ->required()
      ->check(NonEmpty());
  world
      ->add_option("--from-s", options.from_s_m,
                   "Chainage in m to begin at, with --to-s; default: all that frame 0 can see")
      ->check(Number(kChainage));
  world->add_option("--to-s", options.to_s_m, "Chainage in m to end at, with --from-s")
      ->check(Number(kChainage));
  world->callback([&] { command = [&] { return railcast::WorldCommand(options); }; });
}

void AddTrace(CLI::App& app, TraceOptions& options, std::function<int()>& command) {
  CLI::App* trace =
      app.add_subcommand("trace", "Replay one firing and print what each effect makes of it");
  trace->add_option("SCENARIO", options.scenario, "Scenario file")->required()->check(NonEmpty());
  trace->add_option("--sensor", options.sensor,
                    "Name of the sensor, where the scenario has several");
  trace->add_option("--frame", options.frame, "Number of the frame")
      ->transform(Whole({0, kMaxFrame}))
      ->capture_default_str();
  trace
      ->add_option("--firing", options.firing,
                   "Number of the firing in its frame, from 0, in order of time")
      ->required()
      ->transform(Whole({0, kMaxFrame}));
  AddIsa(*trace, options.isa);
  trace->callback([&] { command = [&] { return railcast::TraceCommand(options); }; });
}

int Main(int argc, char** argv) {
  CLI::App app("LiDAR simulation for railways: makes frames from a scenario.");
  app.set_version_flag("--version", "railcast " + railcast::ProgramVersion());
  app.require_subcommand(1);
  app.failure_message(railcast::SayWhatIsWrong);
  app.fallthrough();
  app.footer("Exit status: 0 success, 1 bad input or failed run, 2 usage.");
  bool is_verbose = false;
  app.add_flag("-v,--verbose", is_verbose, "Print more about what is done");
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
