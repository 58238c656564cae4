#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/run/sequence_files.h"
#include "core/scenario/value_type.h"
#include "railcast/transform.h"

namespace railcast {

// What stands beside the sequences of a run of several sensors (docs/files.md).

/// The file that names the folders of several sensors' sequences of one run.
inline constexpr std::string_view kSensorsFile = "sensors.json";

// The files of the clouds of all sensors together, in a folder beside those of the sensors.

inline constexpr std::string_view kMergedFolder = "merged";
/// Names the clouds, what they are made of and their hashes, a line for each. Relative to the
/// folder.
inline constexpr std::string_view kMergedFile = "merged.jsonl";
/// The field that tells from which sensor a point is: its place in sensors.json.
inline constexpr std::string_view kSensorIndexField = "sensor_index";

/// Where a sensor is on its vehicle.
struct MountRecord {
  Vector3 translation_m = Vector3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};
void Describe(Archive& a, MountRecord& s);

/// A sensor's sequence.
struct SensorRecord {
  std::string name;
  std::string folder;  ///< Relative to the directory.
  double rate_hz{};
  double phase_s{};
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  std::uint32_t stride = 1;
  MountRecord vehicle_from_sensor{};  ///< By the nominal mount.
  std::string manifest_hash{};        ///< Hash of its manifest.json; empty before 1.0.
};
void Describe(Archive& a, SensorRecord& s);

/// The folder of the merged clouds.
struct MergedFolderRecord {
  std::string folder;              ///< Relative to the directory.
  NamedValues<std::string> files;  ///< The hashes of the files that are about all clouds.
};
void Describe(Archive& a, MergedFolderRecord& s);

/// The content of sensors.json.
struct SensorsRecord {
  std::uint32_t version = 1;
  std::vector<SensorRecord> sensors{};
  std::optional<MergedFolderRecord> merged{};

  /// Whether it says what each sensor's manifest is, and has a hash of itself.
  [[nodiscard]] bool has_hashes() const;
};
void Describe(Archive& a, SensorsRecord& s);

/// The content of sensors.json as it is written: with its own hash (WithManifestHash()).
[[nodiscard]] std::string SensorsText(const SensorsRecord& record);
/// Reads such a content; its own hash is not checked.
/// @throws InputError "place: rule" if it is none.
[[nodiscard]] SensorsRecord ReadSensorsText(const std::string& text, const std::string& place);

/// What a merged cloud has of a sensor's frame.
struct MergedPartRecord {
  std::string sensor;
  std::uint32_t frame{};
  std::uint32_t later_ns{};  ///< How much later than the first sensor's frame it begins.
};
void Describe(Archive& a, MergedPartRecord& s);

/// A line of merged.jsonl.
struct MergedRecord {
  std::uint32_t frame{};  ///< Frame of the first sensor.
  std::int64_t stamp_ns{};
  KnownFile file;  ///< Relative to the folder.
  std::uint32_t points{};
  std::vector<MergedPartRecord> parts{};
};
void Describe(Archive& a, MergedRecord& s);

/// The folders that a directory's sensors.json names, in its order; none if it has no such file.
/// @throws InputError if the file is not what railcast-generate sequence writes.
[[nodiscard]] std::vector<std::filesystem::path> SensorFoldersIn(
    const std::filesystem::path& directory);

/// The folder of the merged clouds that a directory's sensors.json names, and its files' hashes.
struct MergedFolder {
  std::filesystem::path folder;
  std::vector<KnownFile> files;  ///< Relative to the folder.
};

/// @return Nothing if sensors.json names none.
/// @throws InputError as SensorFoldersIn() does.
[[nodiscard]] std::optional<MergedFolder> MergedFolderIn(const std::filesystem::path& directory);

}  // namespace railcast
