#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/io/cloud_files.h"

namespace railcast {

class Archive;

// The names of the files of a sequence directory (docs/files.md), relative to it.

inline constexpr std::string_view kRunFile = "run.json";
inline constexpr std::string_view kManifestFile = "manifest.json";
/// Beside a run's bag: what it holds.
inline constexpr std::string_view kBagLinesFile = "bag.jsonl";
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

  bool operator==(const KnownFile&) const = default;
};
void Describe(Archive& a, KnownFile& s);
/// Describes a file's size and hash, which stand in a record beside its name.
void DescribeContent(Archive& a, KnownFile& s);

}  // namespace railcast
