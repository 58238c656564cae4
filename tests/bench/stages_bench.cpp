// Measures what the stages of a frame of a sequence cost, beside the raw trace of the same rays:
// time that the processor spent, on one thread, the median over the frames.
//
//   railcast-measure stages SCENARIO [--frames N] [--format FORMAT] [--out DIRECTORY]
//
// Each frame takes all stages in turn, and the raw trace before them.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/io/content_hash.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/object_survey.h"
#include "core/io/write_file.h"
#include "core/program/command_line.h"
#include "railcast/io/cloud_files.h"
#include "railcast/scenario.h"
#include "tests/bench/measurements.h"
#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

struct StagesOptions {
  std::string scenario;
  std::string format = "pcd";
  std::filesystem::path out = "/dev/shm";
  std::uint32_t num_frames = 50;
};

/// Collects times by stage, in the order in which the stages first come.
class StageTimes {
 public:
  template <typename Work>
  void Take(const std::string& stage, const Work& work) {
    Of(stage).push_back(CpuTimeOf_ms(work));
  }

  /// @param unit The stage that is 1.
  void Print(const std::string& unit) {
    const double unit_ms = Median(Of(unit));
    for (const auto& [stage, times_ms] : stages_) {
      const double ms = Median(times_ms);
      std::printf("| %s | %.2f | %.3f |\n", stage.c_str(), ms, ms / unit_ms);
    }
  }

 private:
  std::vector<double>& Of(const std::string& stage) {
    for (auto& [name, times_ms] : stages_) {
      if (name == stage) return times_ms;
    }
    return stages_.emplace_back(stage, std::vector<double>()).second;
  }

  std::vector<std::pair<std::string, std::vector<double>>> stages_;
};

int RunStages(const StagesOptions& options) {
  const ScenarioSpec scenario = ReadScenario(options.scenario);
  const LabelTable labels(scenario.labels);
  const FrameFileSpec files{&ParseFrameFormat(options.format), FieldSelection("all"), labels};
  const auto simulator = MakeSimulator(scenario, 1);
  ObjectSurvey survey(simulator->world(), labels, simulator->spec().detector.range_max_m,
                      simulator->spec().output);
  const std::filesystem::path file = options.out / "railcast-stages.frame";
  Frame frame;
  std::vector<FrameFile> encoded;
  std::vector<ObjectView> views;
  std::vector<ObjectInFrame> objects;
  StageTimes times;
  for (std::uint32_t index = 0; index < options.num_frames; ++index) {
    const auto raw_trace = simulator->MakeRawTrace(index);
    const auto begun = simulator->Begin(index);
    WaitUntilIdle();
    raw_trace();  // Warms the caches.
    times.Take("raw trace", raw_trace);
    times.Take("scan", [&] { simulator->Scan(*begun, frame); });
    times.Take("scan with views of objects", [&] { simulator->Scan(*begun, frame, views); });
    times.Take("objects' places and contacts", [&] { objects = survey.Describe(frame, views); });
    times.Take("objects' line", [&] { static_cast<void>(ObjectsLine(frame, objects)); });
    times.Take("counts", [&] { static_cast<void>(CountFrame(frame, labels)); });
    times.Take("encoding", [&] { EncodeFrameFiles(frame, files, index, encoded, {}); });
    times.Take("hash", [&] {
      for (const FrameFile& each : encoded) static_cast<void>(ContentHash(each.bytes));
    });
    times.Take("writing", [&] {
      for (const FrameFile& each : encoded) WriteFileWhole(file, each.bytes);
    });
  }
  std::filesystem::remove(file);
  std::printf("| stage | ms | x raw trace |\n|---|---|---|\n");
  times.Print("raw trace");
  return kExitSuccess;
}

}  // namespace

void AddStages(ProgramOptions& app, ProgramCommand& command) {
  ProgramOptions stages = app.AddCommand(
      "stages", "Measure what the stages of a frame of a sequence cost, on one thread");
  const auto options = std::make_shared<StagesOptions>();
  stages.AddOption("SCENARIO", options->scenario, "Scenario file").Required().Check(NonEmpty());
  stages.AddOption("--frames", options->num_frames, "Number of frames")
      .Check(Whole({1, 1'000'000}))
      .ShowDefault();
  stages.AddOption("--format", options->format, "File format of the frames")
      .Check(Named(FrameFormatNames()))
      .ShowDefault();
  stages.AddOption("--out", options->out, "Directory to write to").ShowDefault();
  stages.WhenParsed([options, &command] {
    command = [options](const std::string&) { return RunStages(*options); };
  });
}

}  // namespace railcast
