#include <iostream>
#include <memory>
#include <string>
#include <tuple>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/source_choice.h"
#include "core/io/run/run_folder.h"
#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/stop_signals.h"
#include "generator/commands.h"
#include "generator/extras/insert/insert_plan.h"
#include "generator/extras/insert/plan/plan_check.h"
#include "generator/extras/insert/run/insert_run.h"
#include "generator/extras/recording_commands.h"
#include "generator/run/run_options.h"
#include "generator/run/run_plan.h"
#include "generator/sequence/summary.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

struct InsertOptions {
  InsertChoices choices;
  std::string frames;
  SourceChoice choice;
  bool is_check = false;
};

int RunInsertCommand(InsertOptions options) {
  InsertChoices& choices = options.choices;
  if (!options.frames.empty()) {
    std::tie(choices.first_frame, choices.last_frame) = FramesNamed(options.frames);
  }
  if (!options.is_check && choices.directory.empty()) {
    throw InputError("--out: missing (only --check writes nothing)");
  }
  if (!choices.directory.empty()) {
    CheckIsApart(choices);
    CheckIsOutside("--out", choices.directory, true);
  }
  choices.recording = WithChoice({choices.recording}, options.choice).front();
  const InsertPlan plan = ReadInsertPlan(choices.plan, choices.recording);
  for (const std::string& remark : plan.remarks) std::cout << ShownLines(remark) << "\n";
  if (options.is_check) {
    std::cout << ShownLines(PlanCheckText(plan, CheckInsert(choices, plan)));
    return kExitSuccess;
  }
  CatchStopSignals();
  FrameProgress progress;
  const auto show = [&](std::uint32_t num_done, std::uint32_t num) {
    progress.Show(num_done, num);
  };
  const InsertResult result = RunInsert(choices, plan, {show, StopRequested});
  progress.End();
  std::cerr << ShownLines(MendedText(result.changed));
  if (result.is_complete) {
    std::cout << ShownLines(result.text);
    return kExitSuccess;
  }
  std::cerr << "interrupted; the same command continues with frame "
            << choices.first_frame + result.num_done << "\n";
  return kExitInterrupted;
}

void AddInsert(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<InsertOptions>();
  InsertChoices& choices = options->choices;
  ProgramOptions insert = app.AddCommand("insert", OwnProgramOf("insert").description);
  insert.AddOption("RECORDING", choices.recording, "What railcast-analyze reads")
      .Required()
      .Check(NonEmpty());
  insert.AddOption("PLAN", choices.plan, "Scenario whose world is a recording")
      .Required()
      .Check(NonEmpty());
  insert.AddOption("--out", choices.directory, "Directory to write to").Check(NonEmpty());
  insert.AddOption("--frames", options->frames,
                   "First and last frame, counted from 0: 12..30; default: all");
  std::vector<std::string> formats = {"same"};
  for (const FrameFormat& format : FrameFormats()) {
    if (!format.files.empty()) formats.emplace_back(format.name);
  }
  insert.AddOption("--format", choices.format, "The recording's own format, or one of railcast's")
      .Check(Named(formats))
      .ShowDefault();
  insert.AddFlag("--points-alone", choices.may_use_points_alone,
                 "Treat frames point by point if their firings cannot be determined");
  const Option certify = AddCertify(insert, choices.certify);
  const Option threads = AddThreads(insert, choices.num_threads);
  const Option check =
      insert.AddFlag("--check", options->is_check,
                     "Print what the objects meet in the recording, and write nothing");
  for (const Option other : {certify, threads}) check.Excludes(other);
  AddSourceChoice(insert, options->choice);
  AddCaptureSensor(insert, options->choice.sensor);
  insert.Footer(
      "Exit status: 0 success, 1 bad input or failed run, 2 usage, 130 interrupted (the same\n"
      "command continues).");
  insert.WhenParsed([&command, options] {
    command = [options](const std::string&) { return RunInsertCommand(*options); };
  });
}

}  // namespace

void AddInsert(RecordingCommands& extras) {
  extras.commands["insert"] = AddInsert;
}

}  // namespace railcast
