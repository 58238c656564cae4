#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/io/cloud/track_fields.h"
#include "core/io/content_hash.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/camera_files.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/sequence_files.h"
#include "generator/extras/convert/convert.h"
#include "generator/extras/insert/clouds/label_numbers.h"
#include "generator/extras/insert/clouds/recording_output.h"
#include "generator/extras/insert/run/frame_folder.h"
#include "generator/extras/insert/run/insert_run.h"
#include "generator/run/run_directory.h"
#include "railcast/rail_world.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// The folder of a sequence of railcast, which an insertion into one holds, too; empty if it is
/// none.
fs::path SequenceIn(const fs::path& recording) {
  for (const fs::path& folder : {recording, recording / kRecordingFolder}) {
    if (fs::exists(folder / kFramesFile)) return folder;
  }
  return {};
}

/// Whether the recorded clouds have a place for each firing.
bool HasAllSlots(const SequenceSummary& summary) {
  const FrameFormat& format = ParseFrameFormat(summary.run.format);
  return format.has_all_slots || !format.bag.empty();
}

/// The fields that both the recorded points and the new ones have.
/// @param has_outcomes Whether the recording says why firings have no point that get a place.
FieldSelection FieldsOfBoth(const FieldSelection& recorded,
                            const ConvertChoices& choices,
                            bool has_outcomes) {
  std::vector<std::string> there = recorded.names();
  if (!has_outcomes) std::erase(there, "outcome");
  if (!ChosenFields(choices.fields, there).empty())
    return FieldSelection(choices.fields, true, true);
  return FieldSelection(Join(there, ","), true, true);
}

/// The run that writes the sequence.
SequenceSpec SpecOfConverted(const SequenceSummary& summary,
                             const ConvertChoices& choices,
                             const InsertRange& range) {
  const ScenarioSpec scenario = ReadScenario(summary.directory / kScenarioFile);
  const FrameFormat& format = ParseFrameFormat(summary.run.format);
  if (format.files.empty() && format.bag.empty()) {
    throw InputError(ShownPath(summary.directory) + ": must have points (got format " +
                     summary.run.format + ")");
  }
  if (!IsInSensorAxes(scenario.output)) {
    throw InputError(ShownPath(summary.directory) +
                     ": must have its points in the sensor's axes to become a sequence; "
                     "--format mcap or rosbag2 takes them");
  }
  SequenceSpec spec = SpecOfRecorded(summary, scenario);
  const FrameFormat& wanted = ParseFrameFormat(choices.format);

  spec.directory = choices.directory;
  spec.files.format = &wanted;
  const bool has_outcomes = HasAllSlots(summary) || !wanted.has_all_slots;
  spec.files.fields =
      wanted.dataset ? FieldSelection() : FieldsOfBoth(spec.files.fields, choices, has_outcomes);
  if (spec.files.fields.NeedsTrack()) {
    spec.files.fields.SetTrack(std::make_shared<const FrameTrack>(
        FrameTrack{OwnTrack(*MakeWorld(scenario), scenario.world.catenary), scenario.output,
                   VehicleFromSensor(scenario.lidar.mount)}));
  }
  spec.start_frame = summary.run.start_frame + range.first * spec.stride;
  spec.num_frames = range.num;
  return spec;
}

/// A frame on its way from one sequence to another.
struct SequenceSlot {
  std::uint32_t index{};  ///< Among the frames that are written.
  FrameLines lines;
  Recording::FrameReader read;
  EncodedFrame encoded;
};

/// Reads the images of a frame, each under the name that it gets.
std::vector<FrameFile> ImagesOf(const fs::path& source,
                                const SequenceSpec& spec,
                                const FrameRecord& record,
                                std::uint32_t number,
                                const std::string& place) {
  std::vector<std::string> recorded = CameraFileNames(spec.camera, record.frame);
  const std::vector<std::string> wanted = CameraFileNames(spec.camera, number);
  std::vector<FrameFile> images;
  for (const KnownFile& file : record.files) {
    if (!IsCameraFile(file.name)) continue;
    const auto found = std::ranges::find(recorded, file.name);
    if (found == recorded.end()) {
      throw InputError(place + ": files: must be images of the frame's camera, each once (got " +
                       ShownText(file.name) + ")");
    }
    images.push_back({wanted.at(static_cast<std::size_t>(found - recorded.begin())),
                      ReadKnownFile(source, file, kFramesFile)});
    found->clear();
  }
  return images;
}

/// Writes a frame as the sequence's own run would have done it: all but its clouds are as recorded.
void EncodeConverted(const fs::path& source, const SequenceSpec& spec, SequenceSlot& slot) {
  const RecordedFrame recorded = std::exchange(slot.read, {})();
  const FrameLines& lines = slot.lines;
  EncodedFrame& encoded = slot.encoded;
  encoded = {};
  encoded.record = ReadFrameLine(lines.frame.text, lines.frame.place);
  const std::uint32_t number = spec.files.format->dataset ? slot.index : encoded.record.frame;
  EncodeFrameFiles(WithOutcomes(recorded), spec.files, number, encoded.files,
                   MovingInstances(recorded.objects));
  for (FrameFile& image : ImagesOf(source, spec, encoded.record, number, lines.frame.place)) {
    encoded.files.push_back(std::move(image));
  }
  encoded.record.files = KnownFilesOf(encoded.files);
  encoded.record.clouds_hash.clear();
  encoded.pose = ReadPoseRecord(lines.records.at(0).text, lines.records.at(0).place);
  encoded.objects_line = lines.records.at(1).text + "\n";
  for (const PlacedLine& motion : lines.motion) encoded.motion_lines.push_back(motion.text);
}

/// What the new format has no place for.
/// @param counts Of all frames.
Losses LostOfSequence(const SequenceSummary& summary,
                      const SequenceSpec& spec,
                      const FrameCounts& counts) {
  const FrameFormat& to = *spec.files.format;
  Losses lost;
  std::uint64_t num_absent = 0;
  for (std::size_t i = 0; i < counts.outcomes.size(); ++i) {
    if (!HasPoint(static_cast<Outcome>(i))) num_absent += counts.outcomes[i];
  }
  const bool has_all_slots = HasAllSlots(summary);
  AddLoss("figures of certificates", summary.run.certify ? 1 : 0, lost);
  AddLoss("firings without a point", has_all_slots && !to.has_all_slots ? num_absent : 0, lost);
  const FieldSelection recorded = summary.run.fields.empty()
                                      ? FieldSelection()
                                      : FieldSelection(summary.run.fields, true, true);
  if (recorded.Has("outcome") && !has_all_slots && to.has_all_slots) {
    AddLoss("values of outcome, not known without a point", counts.points, lost);
  }
  if (!to.dataset) return lost;

  for (const std::string& name : recorded.names()) {
    if (!IsKittiField(name)) AddLoss("values of " + name, counts.points, lost);
  }
  return lost;
}

void AddListsOfInsertion(const fs::path& recording, const InsertRange& range, Losses& lost) {
  const bool is_insertion = fs::exists(recording / kInsertFile);
  AddLoss("lists of what was put into a frame", is_insertion ? range.num : 0, lost);
}

}  // namespace

bool BecomesSequence(const ConvertChoices& choices) {
  const fs::path folder = SequenceIn(choices.recording);
  if (folder.empty() || ParseFrameFormat(choices.format).files.empty()) return false;
  const FrameFormat* const from = FindFrameFormat(ReadSequenceSummary(folder).run.format);
  return from != nullptr && !from->dataset;
}

Losses LostBesidePoints(const fs::path& recording, const InsertRange& range) {
  Losses lost;
  AddListsOfInsertion(recording, range, lost);
  const fs::path folder = SequenceIn(recording);
  if (folder.empty()) return lost;
  AddLoss("scenarios of the run", 1, lost);
  FrameLineReader lines(ReadSequenceSummary(folder));
  for (std::uint32_t i = 0; i < range.first + range.num; ++i) {
    const FrameLines next = lines.Next().value();
    if (i < range.first) continue;
    const FrameRecord record = ReadFrameLine(next.frame.text, next.frame.place);
    for (const KnownFile& file : record.files) {
      AddLoss("files of images", IsCameraFile(file.name) ? 1 : 0, lost);
    }
    for (const std::uint32_t num : record.motion_lines) {
      AddLoss("samples of motion sensors", num, lost);
    }
  }
  return lost;
}

ConvertResult ConvertSequence(const ConvertChoices& choices, const RunHooks& hooks) {
  const fs::path source = SequenceIn(choices.recording);
  const SequenceSummary summary = ReadSequenceSummary(source);
  const auto recording = OpenRecording(source);
  FrameLineReader lines(summary);
  const InsertRange range = RangeOf(choices.first_frame, choices.last_frame,
                                    static_cast<std::uint32_t>(lines.num_frames()));
  const SequenceSpec spec = SpecOfConverted(summary, choices, range);
  const FolderLock lock(spec.directory);
  RunDirectory directory(spec);
  ConvertResult result;
  result.num = range.num;
  result.was_complete = directory.is_complete();
  result.changed = directory.changed();
  result.num_resumed = directory.num_done();
  std::vector<SequenceSlot> slots;
  const auto take = [&](std::size_t i, std::uint32_t number) {
    slots[i].lines = lines.Next().value();
    slots[i].read = recording->Next().value();
    slots[i].index = number - range.first;
    return true;
  };
  MakeMissing(
      {range, directory.num_done(), choices.num_threads, hooks},
      [&](std::size_t num_slots) { slots.resize(num_slots); }, take,
      {{false, [&](std::size_t i) { EncodeConverted(source, spec, slots[i]); }}},
      [&](std::size_t i) { directory.Write(slots[i].encoded); });
  result.num_done = directory.num_done();
  if (!directory.is_complete() && result.num_done == range.num) directory.Finish();
  result.is_complete = directory.is_complete();
  if (result.is_complete) {
    result.lost = LostOfSequence(summary, spec, directory.counts());
    AddListsOfInsertion(choices.recording, range, result.lost);
  }
  return result;
}

}  // namespace railcast
