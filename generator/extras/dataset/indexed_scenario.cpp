#include "generator/extras/dataset/indexed_scenario.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/insert/insert_record.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/object_record.h"
#include "core/io/run/sequence_files.h"

namespace railcast {
namespace {

IndexObjectRecord IndexObjectOf(const ObjectRecord& object) {
  constexpr double kMillimetres = 1e3;
  const Vector3& center_m = object.sensor.center_m;
  const double distance_m = std::hypot(center_m.x(), center_m.y(), center_m.z());
  return {.name = object.name,
          .type = object.type,
          .label = object.label,
          .instance = object.instance,
          .distance_m = std::round(distance_m * kMillimetres) / kMillimetres,
          .points = object.points,
          .firings_visible = object.firings_visible,
          .firings_alone = object.firings_alone,
          .occlusion = object.occlusion};
}

/// What a line of insert.jsonl says of a frame, with the files of the recording.
FrameRecord ReadInsertedFrame(const PlacedLine& line) {
  FrameRecord record = ReadInsertLine(line.text, line.place).frame;
  const std::string folder = std::string(kRecordingFolder) + "/";
  std::erase_if(record.files,
                [&](const KnownFile& file) { return !file.name.starts_with(folder); });
  for (KnownFile& file : record.files) file.name = file.name.substr(folder.size());
  return record;
}

std::vector<IndexedFrame> ReadIndexedFrames(const std::filesystem::path& dataset,
                                            const SequenceRecord& sequence) {
  std::filesystem::path folder = dataset / sequence.folder;
  // What was put into a recording that is no sequence is known beside it.
  const bool is_sequence = std::filesystem::exists(folder / kFramesFile);
  if (!is_sequence) folder = folder.parent_path();
  const std::filesystem::path frames_file = folder / (is_sequence ? kFramesFile : kInsertFile);
  LineReader lines(frames_file);
  LineReader objects(folder / kObjectsFile);
  std::vector<IndexedFrame> frames;
  for (std::size_t i = 0; i < sequence.vehicle_s_m.size(); ++i) {
    const PlacedLine line = lines.Need();
    IndexedFrame frame{is_sequence ? ReadFrameLine(line.text, line.place) : ReadInsertedFrame(line),
                       sequence.vehicle_s_m[i],
                       sequence.vehicle_speed_mps.at(i),
                       {}};
    const PlacedLine objects_line = objects.Need();
    for (const ObjectRecord& object :
         ReadObjectsRecord(objects_line.text, frame.record.frame, objects_line.place).objects) {
      frame.objects.push_back(IndexObjectOf(object));
    }
    frames.push_back(std::move(frame));
  }
  if (const auto further = lines.Next()) {
    throw InputError(further->place + ": must be the end of " +
                     NumberText(sequence.vehicle_s_m.size()) + " frames");
  }
  return frames;
}

IndexRecord IndexOf(const ScenarioRecord& scenario,
                    const SequenceRecord& sequence,
                    const IndexedFrame& frame) {
  IndexRecord line{.scenario = scenario.scenario,
                   .sensor = sequence.sensor,
                   .frame = frame.record.frame,
                   .split = scenario.split,
                   .folder = sequence.folder,
                   .stamp_ns = frame.record.stamp_ns,
                   .base = scenario.base,
                   .line = scenario.line,
                   .vehicle_s_m = frame.vehicle_s_m,
                   .vehicle_speed_mps = frame.vehicle_speed_mps,
                   .bag = sequence.bag,
                   .trace = sequence.trace,
                   .counts = frame.record.counts,
                   .objects = frame.objects,
                   .drawn = scenario.drawn,
                   .weather = scenario.weather};
  for (const KnownFile& file : frame.record.files) line.files.push_back(file.name);
  return line;
}

}  // namespace

IndexedScenario ReadIndexedScenario(const std::filesystem::path& dataset, const PlacedLine& line) {
  IndexedScenario scenario{ReadRecordLine<ScenarioRecord>(line.text, line.place), {}};
  for (const SequenceRecord& sequence : scenario.record.sequences) {
    scenario.frames.push_back(ReadIndexedFrames(dataset, sequence));
  }
  return scenario;
}

std::string IndexLines(const IndexedScenario& scenario) {
  std::string lines;
  for (std::size_t i = 0; i < scenario.frames.size(); ++i) {
    for (const IndexedFrame& frame : scenario.frames[i]) {
      lines += RecordText(IndexOf(scenario.record, scenario.record.sequences[i], frame)) + "\n";
    }
  }
  return lines;
}

}  // namespace railcast
