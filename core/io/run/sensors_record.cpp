#include "core/io/run/sensors_record.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/run_record.h"
#include "core/io/write_file.h"
#include "core/scenario/archive.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

std::optional<SensorsRecord> ReadSensors(const fs::path& directory) {
  const fs::path file = directory / kSensorsFile;
  if (!fs::exists(file)) return std::nullopt;
  return ReadSensorsText(ReadFileWhole(file), ShownPath(file));
}

}  // namespace

void Describe(Archive& a, MountRecord& s) {
  a.Required("translation_m", s.translation_m, "");
  DescribeRotation(a, s.rotation);
}

void Describe(Archive& a, SensorRecord& s) {
  a.Required("name", s.name, "");
  a.Required("folder", s.folder, "Its sequence.", NonEmptyString());
  a.Required("rate_hz", s.rate_hz, "");
  a.Required("phase_s", s.phase_s, "");
  a.Required("start_frame", s.start_frame, "");
  a.Required("num_frames", s.num_frames, "");
  a.Optional("stride", s.stride, "");
  a.Required("vehicle_from_sensor", s.vehicle_from_sensor, "Its nominal mount.");
  a.Optional("manifest_xxh3", s.manifest_hash, "Hash of its manifest.json.");
}

void Describe(Archive& a, MergedFolderRecord& s) {
  a.Required("folder", s.folder, "Of the merged clouds.", NonEmptyString());
  a.Required("files_xxh3", s.files, "Hashes of merged.jsonl and poses.csv.");
}

void Describe(Archive& a, SensorsRecord& s) {
  a.Required("version", s.version, "", Within(1, 1));
  a.Required("sensors", s.sensors, "In the scenario's order.", NonEmptyList());
  a.Optional("merged", s.merged, "Left out without --merged.");
}

bool SensorsRecord::has_hashes() const {
  return std::ranges::none_of(sensors, &std::string::empty, &SensorRecord::manifest_hash);
}

std::string SensorsText(const SensorsRecord& record) {
  return WithManifestHash(RecordFile(record));
}

SensorsRecord ReadSensorsText(const std::string& text, const std::string& place) {
  return ReadRecord<SensorsRecord>(WithoutManifestHash(text), place);
}

void Describe(Archive& a, MergedPartRecord& s) {
  a.Required("sensor", s.sensor, "");
  a.Required("frame", s.frame, "");
  a.Required("later_ns", s.later_ns, "How much later than the first sensor's frame it begins.");
}

void Describe(Archive& a, MergedRecord& s) {
  a.Required("frame", s.frame, "Of the first sensor.");
  a.Required("stamp_ns", s.stamp_ns, "");
  a.Required("file", s.file.name, "Relative to the folder.", NonEmptyString());
  DescribeContent(a, s.file);
  a.Required("points", s.points, "");
  a.Required("parts", s.parts, "The frames that it is made of.");
}

std::vector<fs::path> SensorFoldersIn(const fs::path& directory) {
  std::vector<fs::path> folders;
  if (const auto record = ReadSensors(directory)) {
    for (const SensorRecord& sensor : record->sensors) folders.push_back(directory / sensor.folder);
  }
  return folders;
}

std::optional<MergedFolder> MergedFolderIn(const fs::path& directory) {
  const auto record = ReadSensors(directory);
  if (!record || !record->merged) return std::nullopt;
  MergedFolder merged{directory / record->merged->folder, {}};
  for (const auto& [name, hash] : record->merged->files) merged.files.push_back({name, hash, {}});
  return merged;
}

}  // namespace railcast
