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
  a.Required("translation_m", s.translation_m, "Position of the sensor in the vehicle's axes.");
  DescribeRotation(a, s.rotation);
}

void Describe(Archive& a, SensorRecord& s) {
  a.Required("name", s.name, "Name of the sensor.");
  a.Required("folder", s.folder, "Folder of its sequence.", NonEmptyString());
  a.Required("rate_hz", s.rate_hz, "Number of frames per second.");
  a.Required("phase_s", s.phase_s, "Stamp of its frame 0, as in the scenario.");
  a.Required("start_frame", s.start_frame, "Number of its first frame.");
  a.Required("num_frames", s.num_frames, "Number of its frames.");
  a.Optional("stride", s.stride, "Step from one frame's number to the next; left out where 1.");
  a.Required("vehicle_from_sensor", s.vehicle_from_sensor, "Its nominal mount.");
  a.Optional("manifest_xxh3", s.manifest_hash, "Hash of its manifest.json.");
}

void Describe(Archive& a, MergedFolderRecord& s) {
  a.Required("folder", s.folder, "Folder of the merged clouds.", NonEmptyString());
  a.Required("files_xxh3", s.files, "Hashes of merged.jsonl and poses.csv.");
}

void Describe(Archive& a, SensorsRecord& s) {
  a.Required("version", s.version, "Version of the file's format.", Within(1, 1));
  a.Required("sensors", s.sensors, "The sensors, in the scenario's order.", NonEmptyList());
  a.Optional("merged", s.merged, "The merged clouds; left out without `--merged`.");
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
  a.Required("sensor", s.sensor, "Name of the sensor.");
  a.Required("frame", s.frame, "Number of the sensor's frame.");
  a.Required("later_ns", s.later_ns,
             "How much later this frame begins than the first sensor's frame.");
}

void Describe(Archive& a, MergedRecord& s) {
  a.Required("frame", s.frame, "Number of the first sensor's frame.");
  a.Required("stamp_ns", s.stamp_ns, "Simulation time at which that frame begins.");
  a.Required("file", s.file.name, "Name of the cloud, relative to the folder.", NonEmptyString());
  DescribeContent(a, s.file);
  a.Required("points", s.points, "Number of points in the cloud.");
  a.Required("parts", s.parts, "The frames of which the cloud is made.");
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
