#include "generator/extras/dataset/inserted_scenarios.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/insert/insert_record.h"
#include "core/extras/insert/insertion_verification.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/line_reader.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/inserter.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class ReadBase final : public RecordedBase {
 public:
  explicit ReadBase(RecordedRun run)
      : run_(std::move(run)), traits_(RecordingTraits(run_.recording)) {
    for (std::uint32_t i = 0; i < run_.num_frames(); ++i) {
      frames_.push_back({run_.way.frame_times_ns[i], run_.Chainage_m(i), run_.line.faces_up.at(i)});
    }
  }

  [[nodiscard]] const RecordedRun& run() const { return run_; }
  [[nodiscard]] const ScenarioSpec& plan() const override { return run_.plan; }
  [[nodiscard]] const std::filesystem::path& recording() const override { return run_.recording; }
  [[nodiscard]] const std::vector<FramePlace>& frames() const override { return frames_; }
  [[nodiscard]] const std::string& Traits() const override { return traits_; }
  [[nodiscard]] ScenarioSpec OnLine(ScenarioSpec plan) const override {
    return OnRecordedLine(run_, std::move(plan));
  }

 private:
  RecordedRun run_;
  std::string traits_;
  std::vector<FramePlace> frames_;
};

/// Hashes of all files of a folder, by their names in it.
std::map<std::string, std::string> HashesIn(const fs::path& directory) {
  std::map<std::string, std::string> hashes;
  for (const auto& entry : fs::recursive_directory_iterator(directory)) {
    if (entry.is_directory()) continue;
    hashes[entry.path().lexically_relative(directory).generic_string()] =
        HashFile(entry.path()).hash;
  }
  return hashes;
}

std::uint64_t PointsIn(const fs::path& directory) {
  std::uint64_t points = 0;
  LineReader lines(directory / kInsertFile);
  while (const auto line = lines.Next()) {
    points += ReadInsertLine(line->text, line->place).frame.counts.points;
  }
  return points;
}

double Speed_mps(const RecordedRun& run, std::uint32_t frame) {
  const std::uint32_t before = frame == 0 ? 0 : frame - 1;
  const std::uint32_t after = std::min(frame + 1, run.num_frames() - 1);
  if (before == after) return 0.0;
  return std::abs(run.Chainage_m(after) - run.Chainage_m(before)) /
         SecondsFromNs(run.way.frame_times_ns[after] - run.way.frame_times_ns[before]);
}

}  // namespace

std::shared_ptr<const RecordedBase> ReadRecordedBase(const std::filesystem::path& plan_file,
                                                     const std::filesystem::path& recording) {
  return std::make_shared<const ReadBase>(ReadRecordedRun(plan_file, recording));
}

const RecordedRun& RunOf(const RecordedBase& base) {
  const auto* const read = dynamic_cast<const ReadBase*>(&base);
  Check(read != nullptr, "the generator reads the recordings of its recipes");
  return read->run();
}

InsertPlan PlanOf(const DrawnScenario& drawn) {
  return MakeInsertPlan(RunOf(*drawn.run), drawn.scenario);
}

InsertResult MakeInserted(const DrawnScenario& drawn,
                          const DatasetChoices& choices,
                          const fs::path& directory,
                          bool is_known,
                          const RunHooks& hooks) {
  const auto name = std::ranges::find_if(
      drawn.record.drawn, [](const auto& each) { return each.first == "recording"; });
  Check(name != drawn.record.drawn.end(), "the scenario of a plan names its recording");
  const InsertPlan plan = PlanOf(drawn);
  return RunInsert({.recording = drawn.run->recording(),
                    .recording_name = name->second.get<std::string>(),
                    .recording_hash = ContentHash(drawn.run->Traits()),
                    .plan = {},
                    .directory = directory,
                    .format = choices.format,
                    .first_frame = drawn.first_frame,
                    .last_frame = drawn.first_frame + drawn.num_frames - 1,
                    .certify = Inserter::CanCertify(plan) ? choices.certify : "off",
                    .num_threads = choices.num_threads,
                    .is_known = is_known},
                   plan, hooks);
}

SequenceRecord RecordOfInserted(const DrawnScenario& drawn,
                                const fs::path& dataset,
                                const fs::path& directory) {
  ErrorList errors;
  for (const std::string& fault : VerifyInsertion(directory, [](double) {}).faults) {
    errors.AddLine(fault);
  }
  errors.ThrowIfAny();
  const RecordedRun& run = RunOf(*drawn.run);
  const fs::path manifest = directory / kManifestFile;
  SequenceRecord record{
      .sensor = drawn.scenario.lidar.name,
      .folder = (directory / kRecordingFolder).lexically_relative(dataset).generic_string(),
      .num_frames = drawn.num_frames,
      .points = PointsIn(directory),
      .scenario_hash =
          ReadRecord<InsertManifestRecord>(ReadManifestText(manifest), ShownPath(manifest))
              .run.plan_hash,
      .data_hash = {},
      .manifest_hash = HashFile(manifest).hash,
      .files = HashesIn(directory)};
  record.data_hash = ContentHash(Json(record.files).dump());
  for (std::uint32_t i = 0; i < drawn.num_frames; ++i) {
    record.vehicle_s_m.push_back(run.Chainage_m(drawn.first_frame + i));
    record.vehicle_speed_mps.push_back(Speed_mps(run, drawn.first_frame + i));
  }
  return record;
}

}  // namespace railcast
