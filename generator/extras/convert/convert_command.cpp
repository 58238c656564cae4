#include <iostream>
#include <memory>
#include <string>
#include <tuple>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_verification.h"
#include "core/io/recording/source_choice.h"
#include "core/io/run/run_folder.h"
#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/stop_signals.h"
#include "generator/commands.h"
#include "generator/extras/convert/convert.h"
#include "generator/extras/insert/run/insert_run.h"
#include "generator/extras/recording_commands.h"
#include "generator/sequence/summary.h"

namespace railcast {
namespace {

struct ConvertOptions {
  ConvertChoices choices;
  std::string frames;
  SourceChoice choice;
};

std::string ConversionReport(const ConvertChoices& choices,
                             const ConvertResult& result,
                             bool is_set) {
  std::string text =
      Amount(result.num, is_set ? "scenarios" : "frames") + " in format " + choices.format + "\n";
  for (const auto& [what, number] : result.lost) {
    text += "not in " + choices.format + ": " + ShownText(Amount(number, what)) + "\n";
  }
  return text + "written to " + ShownPath(choices.directory) + "\n";
}

int RunConvertCommand(ConvertOptions options) {
  ConvertChoices& choices = options.choices;
  CheckIsOutside("OUT", choices.directory, true);
  if (!options.frames.empty()) {
    std::tie(choices.first_frame, choices.last_frame) = FramesNamed(options.frames);
  }
  const bool is_set = IsDataset(choices.recording);
  choices.recording = WithChoice({choices.recording}, options.choice).front();
  CatchStopSignals();
  FrameProgress progress;
  const auto show = [&](std::uint32_t num_done, std::uint32_t num) {
    progress.Show(num_done, num);
  };
  const ConvertResult result = RunConvert(choices, {show, StopRequested});
  progress.End();
  std::cerr << ShownLines(MendedText(result.changed));
  if (result.is_complete) {
    std::cout << ConversionReport(choices, result, is_set);
    return kExitSuccess;
  }
  std::cerr << "interrupted; the same command continues with " << (is_set ? "scenario " : "frame ")
            << choices.first_frame + result.num_done << "\n";
  return kExitInterrupted;
}

void AddConvert(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<ConvertOptions>();
  ConvertChoices& choices = options->choices;
  ProgramOptions convert = app.AddCommand("convert", OwnProgramOf("convert").description);
  convert.AddOption("RECORDING", choices.recording, "What railcast-analyze reads, or a data set")
      .Required()
      .Check(NonEmpty());
  convert.AddOption("OUT", choices.directory, "Directory to write to").Required().Check(NonEmpty());
  convert.AddOption("--format", choices.format, "File format of the frames")
      .Check(Named(ConvertFormats()))
      .ShowDefault();
  convert
      .AddOption("--fields", choices.fields,
                 "Fields to write, separated by commas, or all of the recording's; for mcap and "
                 "rosbag2 also a layout of points: railcast, velodyne, ouster, hesai, livox, aeva "
                 "or autoware")
      .ShowDefault();
  convert.AddOption("--frames", options->frames,
                    "First and last frame, counted from 0: 12..30; default: all");
  AddThreads(convert, choices.num_threads);
  AddSourceChoice(convert, options->choice);
  AddCaptureSensor(convert, options->choice.sensor);
  convert.Footer(
      "OUT becomes a folder, whatever its name ends in; captures are not written.\n"
      "Exit status: 0 success, 1 bad input or failed run, 2 usage, 130 interrupted (the same\n"
      "command continues).");
  convert.WhenParsed([&command, options] {
    command = [options](const std::string&) { return RunConvertCommand(*options); };
  });
}

}  // namespace

void AddConvert(RecordingCommands& extras) {
  extras.commands["convert"] = AddConvert;
}

}  // namespace railcast
