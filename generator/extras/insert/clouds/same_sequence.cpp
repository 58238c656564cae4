#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/recording/firing_truth.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/camera_files.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/clouds/edit_cloud.h"
#include "generator/extras/insert/clouds/inserted_objects.h"
#include "generator/extras/insert/clouds/recording_output.h"

namespace railcast {
namespace {

/// Counts changed by what was inserted.
FrameCounts CountsWith(FrameCounts counts,
                       const RecordedFirings& firings,
                       const InsertedFrame& inserted,
                       const LabelTable& labels) {
  const Frame& before = firings.recorded.frame;
  const Frame& after = inserted.recorded.frame;
  const auto name_of = [&](std::uint32_t id) {
    const Label* const label = labels.Find(id);
    return label == nullptr ? std::string() : label->name;
  };
  const auto count = [&](const Frame& frame, std::uint32_t slot, std::uint64_t change) {
    counts.points += change;
    const std::string name = name_of(frame.label[slot]);
    if (!name.empty()) counts.points_per_label[name] += change;
  };
  for (const SlotEdit& edit : inserted.edits) {
    if (edit.had_point) count(before, edit.slot, ~std::uint64_t{0});
    if (edit.has_point)
      count(edit.is_added || !edit.from_slot ? after : before,
            edit.is_added ? edit.slot : edit.from_slot.value_or(edit.slot), 1);
    if (edit.slot % before.returns != 0 || !HasAllOutcomes(firings.recorded)) continue;
    --counts.outcomes.at(static_cast<std::size_t>(before.outcome[edit.slot]));
    ++counts.outcomes.at(static_cast<std::size_t>(after.outcome[edit.slot]));
  }
  std::erase_if(counts.points_per_label, [](const auto& label) { return label.second == 0; });
  return counts;
}

/// A run of railcast with what was inserted, as if it had been made so.
class SameSequence : public RecordingOutput {
 public:
  SameSequence(const SequenceSummary& summary,
               SequenceSpec spec,
               LabelNumbers labels,
               const InsertRange& range)
      : summary_(summary), spec_(std::move(spec)), labels_(std::move(labels)), range_(range) {
    FrameLineReader reader(summary);
    while (auto lines = reader.Next()) lines_.push_back(std::move(*lines));
    spec_.start_frame = summary.run.start_frame + range.first * spec_.stride;
    spec_.num_frames = range.num;
  }

  [[nodiscard]] std::uint32_t Begin(std::uint32_t num_done) override {
    // The folder is this run's, and its manifest of no use before that of the run.
    lock_.emplace(spec_.directory);
    WriteFileWhole(spec_.directory / kRunFile, RunJson(spec_));
    std::error_code none;
    std::filesystem::remove(spec_.directory / kManifestFile, none);
    directory_.emplace(spec_, num_done);
    return directory_->num_done();
  }

  [[nodiscard]] WrittenFrame Encode(const RecordedFirings& firings,
                                    const InsertedFrame& inserted,
                                    std::uint32_t frame) const override {
    const FrameLines& lines = lines_.at(frame);
    const FrameRecord line = ReadFrameLine(lines.frame.text, lines.frame.place);
    std::vector<FrameFile> clouds;
    std::vector<FrameFile> images;
    for (const KnownFile& file : line.files) {
      const bool is_image = IsCameraFile(file.name);
      (is_image ? images : clouds)
          .push_back({file.name, ReadKnownFile(summary_.directory, file, kFramesFile)});
    }
    WrittenFrame output;
    output.source_hash = SourceHash(clouds);
    const bool is_organised = spec_.files.format->has_all_slots;
    if (!clouds.empty()) {
      output.slots =
          EditCloud(firings, inserted, {.labels = &labels_, .is_organised = is_organised}, clouds);
    }
    clouds.insert(clouds.end(), std::make_move_iterator(images.begin()),
                  std::make_move_iterator(images.end()));
    if (spec_.files.format->dataset) Renumber(frame - range_.first, clouds);
    output.frame = Encoded(lines, firings, inserted, std::move(clouds));
    return output;
  }

  void Write(const RecordedFirings& /*firings*/,
             const InsertedFrame& /*inserted*/,
             WrittenFrame& output) override {
    directory_->Write(*output.frame);
  }
  void Finish() override {
    if (!directory_->is_complete()) directory_->Finish();
  }

 private:
  // KITTI's files are numbered from 0.
  void Renumber(std::uint32_t number, std::vector<FrameFile>& files) const {
    const std::vector<std::string> names = FrameFileNames(*spec_.files.format, number);
    for (std::size_t i = 0; i < names.size() && i < files.size(); ++i) files[i].name = names[i];
  }

  [[nodiscard]] EncodedFrame Encoded(const FrameLines& lines,
                                     const RecordedFirings& firings,
                                     const InsertedFrame& inserted,
                                     std::vector<FrameFile> files) const {
    EncodedFrame encoded;
    encoded.record = ReadFrameLine(lines.frame.text, lines.frame.place);
    encoded.record.files = KnownFilesOf(files);
    encoded.record.certificate = inserted.certificate;
    encoded.record.counts =
        CountsWith(encoded.record.counts, firings, inserted, spec_.files.labels);
    encoded.files = std::move(files);
    const PlacedLine& pose = lines.records.at(0);
    encoded.pose = ReadPoseRecord(pose.text, pose.place);
    const PlacedLine& objects = lines.records.at(1);
    encoded.objects_line = ObjectsWith(
        ReadObjectsRecord(objects.text, encoded.record.frame, objects.place), firings, inserted);
    for (const PlacedLine& motion : lines.motion) encoded.motion_lines.push_back(motion.text);
    return encoded;
  }

  SequenceSummary summary_;
  SequenceSpec spec_;
  LabelNumbers labels_;
  InsertRange range_;
  std::vector<FrameLines> lines_;  ///< Lines of the whole recording.
  std::optional<FolderLock> lock_;
  std::optional<RunDirectory> directory_;
};

}  // namespace

SequenceSpec SpecOfRecorded(const SequenceSummary& summary, const ScenarioSpec& scenario) {
  const RunRecord& run = summary.run;
  SequenceSpec spec;
  spec.version = run.version;
  spec.embree_version = run.embree;
  spec.isa = run.isa;
  spec.identity = IdentityOf(scenario);
  if (!run.commands_hash.empty())
    spec.commands_jsonl = ReadFileWhole(summary.directory / kCommandsFile);
  spec.seed = run.seed;
  if (summary.manifest && !summary.manifest->fidelity_choice.is_null()) {
    spec.fidelity_choice_json = summary.manifest->fidelity_choice.dump();
  }
  spec.files = {
      .format = &ParseFrameFormat(run.format),
      .fields = run.fields.empty() ? FieldSelection() : FieldSelection(run.fields, true, true),
      .labels = LabelTable(scenario.labels)};
  if (scenario.camera) {
    spec.camera = scenario.camera->name;
    spec.calibration_json =
        ReadFileWhole(summary.directory / CalibrationFileName(scenario.camera->name));
  }
  if (!run.motion_sensors.empty()) spec.motion_sensors = scenario.motion_sensors;
  spec.materials = MaterialLibrary(scenario.materials);
  spec.stride = run.stride();
  return spec;
}

std::unique_ptr<RecordingOutput> MakeSameSequence(const RecordingInfo& info,
                                                  const InsertPlan& plan,
                                                  const InsertRange& range,
                                                  const SameSequenceChoices& choices) {
  if (!std::filesystem::exists(info.source / kFramesFile)) return nullptr;
  const SequenceSummary summary = ReadSequenceSummary(info.source);
  const ScenarioSpec scenario = ReadScenario(info.source / kScenarioFile);
  const auto refuse = [&](const std::string& rule) {
    throw InputError(ShownPath(info.source) + ": " + rule + "; choose another --format than same");
  };
  const FrameFormat& format = ParseFrameFormat(summary.run.format);
  if (format.files.empty()) refuse("must have clouds in files of their own");
  if (!format.dataset && !IsInSensorAxes(scenario.output))
    refuse("must have its points in the sensor's axes");
  SequenceSpec spec = SpecOfRecorded(summary, scenario);
  spec.directory = choices.folder;
  spec.certify = choices.certify;
  return std::make_unique<SameSequence>(summary, std::move(spec), LabelNumbersOf(plan, info),
                                        range);
}

}  // namespace railcast
