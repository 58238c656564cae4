#include "generator/dataset/indexed_scenario.h"

#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/sequence_files.h"
#include "core/io/strict_json.h"
#include "core/io/write_file.h"
#include "generator/insert/run/insert_folder.h"

namespace railcast {
namespace {

IndexedObject IndexedObjectOf(const StrictJson& json, const std::string& place) {
  IndexedObject object{.name = json.at("name"),
                       .type = json.at("type"),
                       .label = json.at("label"),
                       .instance = json.at("instance"),
                       .distance_m = 0.0,
                       .points = json.at("points"),
                       .firings_visible = json.at("firings_visible"),
                       .firings_alone = json.at("firings_alone"),
                       .occlusion = ReadOcclusion(json, place)};
  const auto center_m = json.at("sensor").at("center_m").get<std::array<double, 3>>();
  constexpr double kMillimetres = 1e3;
  object.distance_m =
      std::round(std::hypot(center_m[0], center_m[1], center_m[2]) * kMillimetres) / kMillimetres;
  return object;
}

Json ObjectJson(const IndexedObject& object) {
  Json json = {{"name", object.name},
               {"type", object.type},
               {"label", object.label},
               {"instance", object.instance},
               {"distance_m", object.distance_m},
               {"points", object.points},
               {"firings_visible", object.firings_visible},
               {"firings_alone", object.firings_alone},
               {"occlusion", nullptr}};
  if (object.occlusion) json["occlusion"] = *object.occlusion;
  return json;
}

/// Reads a line of objects.jsonl.
std::vector<IndexedObject> ReadIndexedObjects(const std::string& line, const std::string& place) {
  std::vector<IndexedObject> objects;
  ReadRecordedJson<StrictJson>(line, place, [&](const StrictJson& json) {
    for (const StrictJson& object : json.at("objects")) {
      objects.push_back(
          IndexedObjectOf(object, place + ": /objects/" + std::to_string(objects.size())));
    }
    return true;
  });
  return objects;
}

/// What a line of insert.jsonl says of a frame, with the files of the recording.
FrameRecord ReadInsertedFrame(const std::string& line, const std::string& place) {
  return ReadRecordedJson<StrictJson>(line, place, [](const StrictJson& json) {
    FrameRecord record;
    record.frame = json.at("frame");
    record.stamp_ns = json.at("stamp_ns");
    record.counts.points = json.at("points");
    const std::string folder = std::string(kRecordingFolder) + "/";
    for (const StrictJson& file : json.at("files")) {
      const std::string name = file.at("name");
      if (!name.starts_with(folder)) continue;
      record.files.push_back({name.substr(folder.size()), file.at("bytes"), file.at("xxh3")});
    }
    return record;
  });
}

IndexedSequence ReadIndexedSequence(const std::filesystem::path& dataset, const Json& record) {
  IndexedSequence sequence{record, {}};
  std::filesystem::path folder = dataset / record.at("folder").get<std::string>();
  // What was put into a recording that is no sequence is known beside it.
  const bool is_sequence = std::filesystem::exists(folder / kFramesFile);
  if (!is_sequence) folder = folder.parent_path();
  const std::filesystem::path frames_file = folder / (is_sequence ? kFramesFile : kInsertFile);
  std::istringstream frames(ReadFileWhole(frames_file));
  std::istringstream objects(ReadFileWhole(folder / kObjectsFile));
  const Json& s_m = record.at("vehicle_s_m");
  const Json& speed_mps = record.at("vehicle_speed_mps");
  const std::string place = ShownPath(frames_file);
  std::string frame_line;
  std::string objects_line;
  for (std::size_t i = 0; std::getline(frames, frame_line); ++i) {
    auto frame_record =
        is_sequence
            ? ParseFrameLine(frame_line)
            : std::optional(ReadInsertedFrame(frame_line, place + ":" + std::to_string(i + 1)));
    if (!frame_record || i >= s_m.size() || !std::getline(objects, objects_line)) {
      throw InputError(place + ":" + std::to_string(i + 1) + ": is damaged");
    }
    IndexedFrame frame{
        std::move(*frame_record), s_m[i].get<double>(), speed_mps[i].get<double>(), {}};
    const std::string objects_place =
        ShownPath(folder / kObjectsFile) + ":" + std::to_string(i + 1);
    frame.objects = ReadIndexedObjects(objects_line, objects_place);
    sequence.frames.push_back(std::move(frame));
  }
  if (sequence.frames.size() == s_m.size()) return sequence;
  throw InputError(place + ": must have a line for each of " + NumberText(s_m.size()) +
                   " frames (got " + NumberText(sequence.frames.size()) + ")");
}

std::string IndexLine(const Json& scenario, const Json& sequence, const IndexedFrame& frame) {
  Json files = Json::array();
  for (const WrittenFile& file : frame.record.files) files.push_back(file.name);
  Json objects = Json::array();
  for (const IndexedObject& object : frame.objects) objects.push_back(ObjectJson(object));
  Json line = {{"scenario", scenario.at("scenario")},
               {"sensor", sequence.at("sensor")},
               {"frame", frame.record.frame},
               {"split", scenario.at("split")},
               {"folder", sequence.at("folder")},
               {"files", std::move(files)},
               {"stamp_ns", frame.record.stamp_ns},
               {"base", scenario.at("base")},
               {"line", scenario.at("line")},
               {"vehicle_s_m", frame.vehicle_s_m},
               {"vehicle_speed_mps", frame.vehicle_speed_mps}};
  for (const char* const file : {"bag", "trace"}) {
    if (sequence.contains(file)) line[file] = sequence.at(file);
  }
  PutCounts(frame.record.counts, line);
  line["objects"] = std::move(objects);
  line["drawn"] = scenario.at("drawn");
  line["weather"] = scenario.at("weather");
  return line.dump() + "\n";
}

}  // namespace

IndexedScenario ReadIndexedScenario(const std::filesystem::path& dataset, Json record) {
  IndexedScenario scenario{std::move(record), {}};
  for (const Json& sequence : scenario.record.at("sequences")) {
    scenario.sequences.push_back(ReadIndexedSequence(dataset, sequence));
  }
  return scenario;
}

std::string IndexLines(const IndexedScenario& scenario) {
  std::string lines;
  for (const IndexedSequence& sequence : scenario.sequences) {
    for (const IndexedFrame& frame : sequence.frames) {
      lines += IndexLine(scenario.record, sequence.record, frame);
    }
  }
  return lines;
}

}  // namespace railcast
