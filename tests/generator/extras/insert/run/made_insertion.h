#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/io/write_file.h"
#include "tests/core/io/recording/made_sequence.h"

namespace railcast {

inline constexpr const char* kBox =
    R"({"name": "crate", "type": "box", "size_m": [2, 3, 3], "s_m": 300, "h_m": 0})";

/// The line of MakeSequence()'s run, so that chainages are the same.
inline constexpr const char* kSameLine =
    R"({"alignment": {"course": {"type": "elements", "elements": )"
    R"([{"type": "arc", "length_m": 900, "radius_m": 500}]}}})";

/// A plan for MakeSequence()'s run.
/// @param recording The section world.recording.
inline std::filesystem::path WriteRunPlan(const std::filesystem::path& folder,
                                          const std::string& object,
                                          const std::string& recording = kSameLine,
                                          const std::string& lidar = "") {
  const std::string scenarios = RAILCAST_SOURCE_DIR "/scenarios/";
  const std::filesystem::path file = folder / "plan.json";
  WriteFileWhole(
      file, R"({"version": 1, "fidelity": "plausibility", "lidar": {"file": ")" + scenarios +
                R"(sensors/vir2rail.json", "mount": {"position_m": )" +
                R"([2.2, 0.1, 2.5], "pitch_deg": 3})" + lidar + R"(}, "world": {"recording": )" +
                recording + R"(, "objects": [)" + object + R"(]}, "materials": ")" + scenarios +
                R"(materials/railway.json", "labels": ")" + scenarios + "labels.json\"}\n");
  return file;
}

inline constexpr const char* kAlongBeams = R"(, "plausibility": {"noise_shape": "beam"})";

inline MadeSequenceSpec RunWith(const std::string& format, const std::string& object) {
  MadeSequenceSpec made{.format = format, .object = object};
  // KITTI's clouds do not say which beam a point is of, so that points must lie on their beams.
  if (format == "kitti") made.lidar = kAlongBeams;
  return made;
}

/// The bytes of all files below a folder, by name.
inline std::map<std::string, std::string> FilesOf(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[entry.path().lexically_relative(folder).string()] = ReadFileWhole(entry.path());
  }
  return files;
}

}  // namespace railcast
