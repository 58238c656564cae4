#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/io/cloud_files.h"

namespace railcast {

// The names of the files of a sequence directory (docs/files.md), relative to it.

inline constexpr std::string_view kRunFile = "run.json";
inline constexpr std::string_view kManifestFile = "manifest.json";
inline constexpr std::string_view kScenarioFile = "scenario.resolved.json";
inline constexpr std::string_view kLabelsFile = "labels.json";
inline constexpr std::string_view kMaterialsFile = "materials.json";
inline constexpr std::string_view kCommandsFile = "commands.jsonl";
inline constexpr std::string_view kPosesFile = "poses.csv";
inline constexpr std::string_view kObjectsFile = "objects.jsonl";
inline constexpr std::string_view kFramesFile = "frames.jsonl";
inline constexpr std::string_view kKittiPosesFile = "sequences/00/poses.txt";
inline constexpr std::string_view kKittiTimesFile = "sequences/00/times.txt";
inline constexpr std::string_view kKittiCalibrationFile = "sequences/00/calib.txt";
inline constexpr std::string_view kKittiLabelsFile = "semantic-kitti-railcast.yaml";

/// The folder of the files that the scenario names. Each lies in a folder of its own, named by the
/// file's hash: "inputs/0123456789abcdef/wagon.obj".
inline constexpr std::string_view kInputsFolder = "inputs";

/// The folder of the cameras' images and the name of a camera's calibration file:
/// "camera/front/calibration.json".
inline constexpr std::string_view kCameraFolder = "camera";
inline constexpr std::string_view kCalibrationName = "calibration.json";

/// The folder of the motion sensors' samples: "motion/imu.csv".
inline constexpr std::string_view kMotionFolder = "motion";

// The files of the clouds of all sensors of a run together (docs/files.md), in a folder beside
// those of the sensors.

inline constexpr std::string_view kMergedFolder = "merged";
/// Names the clouds, what they are made of and their hashes, a line for each. Relative to the
/// folder.
inline constexpr std::string_view kMergedFile = "merged.jsonl";
/// The field that tells from which sensor a point is: its place in sensors.json.
inline constexpr std::string_view kSensorIndexField = "sensor_index";

/// The files of an image, in folders below that of its camera.
[[nodiscard]] const std::vector<FrameFileKind>& CameraFileKinds();

/// Whether the file belongs to a camera.
[[nodiscard]] bool IsCameraFile(std::string_view name);

/// Whether the file is a bag of a run, or in the directory of one.
[[nodiscard]] bool IsOfBag(std::string_view name);

/// The number of a frame, or of a data set's scenario, in the names of its files: at least six
/// digits.
[[nodiscard]] std::string FrameDigits(std::uint32_t number);

/// Whether a sequence directory of any format may hold a file of this name: one of the names above,
/// that of a frame, of an image, of a motion sensor or of an input. While a file is being written,
/// kUnfinishedSuffix follows its name.
/// @param name Relative to the directory, with slashes: "frames/000012.pcd".
[[nodiscard]] bool IsSequenceFile(std::string_view name);

/// A file of a sequence directory and the content that it must have.
struct KnownFile {
  std::string name;                    ///< Relative to the directory.
  std::string hash;                    ///< ContentHash of its bytes.
  std::optional<std::uint64_t> bytes;  ///< Size in bytes; absent where it is not recorded.
};

/// The file that names the folders of several sensors' sequences of one run.
inline constexpr std::string_view kSensorsFile = "sensors.json";

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
