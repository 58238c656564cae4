#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_verification.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/sequence_files.h"
#include "core/program/version.h"
#include "generator/extras/convert/convert_output.h"
#include "generator/extras/insert/plan/recorded_run.h"
#include "generator/extras/insert/run/frame_folder.h"
#include "generator/extras/insert/run/insert_run.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Reads the first frame that is wanted and, for KITTI, others until it is known what all have.
SourceSurvey SurveyOf(const ConvertChoices& choices) {
  SourceFrames source(choices.recording);
  const auto& num_frames = source.info().num_frames;
  const bool is_dataset = ParseFrameFormat(choices.format).dataset.has_value();
  SourceSurvey survey;
  std::uint32_t num = 0;
  while (const auto read = source.Next()) {
    const std::uint32_t number = num++;
    const bool is_first = number == choices.first_frame;
    const bool is_wanted =
        number > choices.first_frame && number <= choices.last_frame.value_or(number);
    if (is_wanted && !is_dataset && num_frames) break;
    const bool is_known = !is_dataset || (!survey.has_poses && survey.has_stamps);
    if (!is_first && (!is_wanted || is_known)) continue;
    SourceFrame frame = (*read)();
    survey.has_poses = survey.has_poses && frame.recorded.has_pose;
    survey.has_stamps = survey.has_stamps || frame.recorded.frame.stamp_ns != 0;
    if (is_first) survey.first = std::move(frame);
  }
  survey.range = RangeOf(choices.first_frame, choices.last_frame,
                         static_cast<std::uint32_t>(num_frames.value_or(num)));
  return survey;
}

/// A frame on its way from the recording to the folder.
struct ConvertSlot {
  std::uint32_t number{};
  std::function<SourceFrame()> read;
  ConvertedFrame frame;
};

/// The conversion of a recording that is no sequence, or does not become one.
class RecordingConversion {
 public:
  RecordingConversion(const ConvertChoices& choices, const RunHooks& hooks)
      : choices_(choices),
        hooks_(hooks),
        survey_(SurveyOf(choices)),
        source_(choices.recording),
        output_(MakeConvertOutput(choices, source_.info(), survey_)),
        run_{.version = ProgramVersion(),
             .recording = choices.recording.lexically_normal().generic_string(),
             .recording_hash = ContentHash(RecordingTraits(choices.recording)),
             .kind = source_.info().kind,
             .format = choices.format,
             .fields = choices.fields,
             .first_frame = survey_.range.first,
             .num_frames = survey_.range.num},
        folder_({.directory = choices.directory,
                 .made = "a conversion",
                 .run = RecordFile(run_),
                 .first_frame = survey_.range.first,
                 .num_frames = survey_.range.num,
                 .line_files = output_->LineFiles(),
                 .ledger = std::string(kConvertFile)}) {}

  ConvertResult Run() {
    const auto write_fixed = [&] {
      for (const FixedFile& file : output_->FixedFiles()) folder_.WriteFixed(file);
    };
    ConvertResult result{folder_.Fill(output_, write_fixed, [&] { MakeFrames(); })};
    result.num = survey_.range.num;
    if (result.num_done == survey_.range.num) {
      result.lost = LostOfFrames();
      if (!folder_.is_complete()) Finish(result.lost);
    }
    result.is_complete = folder_.is_complete();
    return result;
  }

 private:
  void MakeFrames() {
    std::vector<ConvertSlot> slots;
    const auto take = [&](std::size_t i, std::uint32_t number) {
      auto read = source_.Next();
      if (!read) return false;
      slots[i].number = number;
      slots[i].read = std::move(*read);
      return true;
    };
    const auto encode = [&](std::size_t i) {
      ConvertSlot& slot = slots[i];
      const SourceFrame source = std::exchange(slot.read, {})();
      slot.frame = {};
      slot.frame.record.frame.frame = slot.number;
      slot.frame.record.frame.stamp_ns = source.recorded.frame.stamp_ns;
      output_->Encode(source, slot.number, slot.frame);
      AddLostOf(source, slot.frame.record.lost);
    };
    const auto write = [&](std::size_t i) {
      output_->Write(slots[i].frame);
      folder_.Write(slots[i].frame.files, slots[i].frame.lines, slots[i].frame.record);
    };
    MakeMissing(
        {survey_.range, folder_.num_done(), choices_.num_threads, hooks_},
        [&](std::size_t num_slots) { slots.resize(num_slots); }, take, {{false, encode}}, write);
  }

  /// What no format has a place for.
  static void AddLostOf(const SourceFrame& source, Losses& lost) {
    AddLoss("boxes of objects", source.recorded.objects.size(), lost);
    for (const Remark& remark : source.cloud.remarks) {
      const bool is_moved = remark.kind == RemarkKind::kViewpointUnused;
      AddLoss("viewpoints other than the origin", is_moved ? 1 : 0, lost);
    }
  }

  [[nodiscard]] Losses LostOfFrames() const {
    Losses lost = output_->LostOfAll();
    std::uint64_t num_points = 0;
    LineReader lines(choices_.directory / kConvertFile);
    while (const auto line = lines.Next()) {
      const ConvertRecord record = ReadConvertLine(line->text, line->place);
      num_points += record.frame.counts.points;
      for (const auto& [what, number] : record.lost) AddLoss(what, number, lost);
    }
    for (const auto& [what, number] : LostBesidePoints(choices_.recording, survey_.range)) {
      AddLoss(what, number, lost);
    }
    AddLoss("names of materials", source_.info().materials.size(), lost);
    const fs::path folder = KittiSourceOf(choices_.recording).clouds;
    const bool is_received =
        source_.info().kind == "received stream" && !fs::exists(folder / kConvertFile);
    AddLoss("runs, lost points and times of arrival", is_received ? survey_.range.num : 0, lost);
    const auto num_sequences = KittiSequencesIn(folder).size();
    AddLoss("poses.txt and times.txt of several sequences", num_sequences > 1 ? num_sequences : 0,
            lost);
    const auto& scenario = source_.info().scenario;
    if (source_.info().origin && scenario && !IsInSensorAxes(scenario->output)) {
      AddLoss("positions turned into the sensor's axes, rounded", num_points, lost);
    }
    return lost;
  }

  void Finish(const Losses& lost) {
    output_->Finish();
    folder_.Finish(ConvertManifestRecord{.run = run_, .lost = lost}, output_->WholeFiles());
  }

  const ConvertChoices& choices_;
  const RunHooks& hooks_;
  SourceSurvey survey_;
  SourceFrames source_;
  std::unique_ptr<ConvertOutput> output_;
  ConvertRunRecord run_;
  FrameFolder folder_;
};

}  // namespace

std::vector<std::string> ConvertFormats() {
  std::vector<std::string> names;
  for (const FrameFormat& format : FrameFormats()) {
    if (!format.files.empty() || !format.bag.empty()) names.emplace_back(format.name);
  }
  return names;
}

ConvertResult RunConvert(const ConvertChoices& choices, const RunHooks& hooks) {
  if (IsInFolder(choices.directory, KittiSourceOf(choices.recording).clouds)) {
    throw InputError("OUT: must not be in the recording's directory (got " +
                     ShownPath(choices.directory) + ")");
  }
  const auto& dataset = ParseFrameFormat(choices.format).dataset;
  if (dataset && choices.fields != "all") {
    throw InputError("--fields: " + std::string(dataset->title) +
                     "'s are fixed, so it must be left out with --format " + choices.format +
                     " (got " + choices.fields + ")");
  }
  if (IsDataset(choices.recording)) return ConvertDataset(choices, hooks);
  if (BecomesSequence(choices)) return ConvertSequence(choices, hooks);
  return RecordingConversion(choices, hooks).Run();
}

}  // namespace railcast
