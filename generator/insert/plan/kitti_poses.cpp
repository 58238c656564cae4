#include "generator/insert/plan/kitti_poses.h"

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/recording_kinds.h"
#include "generator/insert/plan/pose_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

std::string PlaceInFile(const fs::path& file, std::size_t line) {
  return ShownPath(file) + ":" + NumberText(line);
}

std::vector<std::string> AllLines(const fs::path& file) {
  const std::string text = ReadFileWhole(file);
  std::string_view rest = text;
  std::vector<std::string> lines;
  while (const auto line = TakeLine(rest)) lines.emplace_back(*line);
  return lines;
}

std::vector<std::string> KittiLinesIn(const fs::path& file, std::size_t num_frames) {
  std::vector<std::string> lines = AllLines(file);
  if (lines.size() == num_frames) return lines;
  throw InputError(ShownPath(file) + ": must have a line for each of the " +
                   NumberText(num_frames) + " frames" + Got(lines.size()));
}

/// The pose of the velodyne in the axes of camera 0.
std::optional<Transform> ReadCalibration(const fs::path& file) {
  if (!exists(file)) return std::nullopt;
  const std::string text = ReadFileWhole(file);
  std::string_view rest = text;
  for (std::size_t number = 1; const auto line = TakeLine(rest); ++number) {
    if (!line->starts_with("Tr:")) continue;
    return ReadKittiPose(std::string(line->substr(3)), PlaceInFile(file, number));
  }
  return std::nullopt;
}

}  // namespace

KittiPoses ReadKittiPoses(const fs::path& source, std::size_t num_frames) {
  const std::vector<fs::path> sequences = KittiSequencesIn(source);
  if (sequences.size() > 1) return {};
  // As the folder is named by "velodyne", "velodyne/" and, from within it, ".".
  const fs::path name = fs::absolute(source / "").lexically_normal().parent_path().filename();
  const fs::path given = name == "velodyne" ? (source / "..").lexically_normal() : source;
  const fs::path folder = sequences.empty() ? given : sequences.front();
  KittiPoses read;
  const auto camera_from_sensor = ReadCalibration(folder / "calib.txt");
  const fs::path poses = folder / "poses.txt";
  if (exists(poses) && camera_from_sensor) {
    std::size_t number = 1;
    for (const std::string& line : KittiLinesIn(poses, num_frames)) {
      const Transform pose = ReadKittiPose(line, PlaceInFile(poses, number++));
      read.world_from_sensor.push_back(camera_from_sensor->inverse() * pose * *camera_from_sensor);
    }
  }
  const fs::path times = folder / "times.txt";
  if (!exists(times)) return read;
  std::size_t number = 1;
  for (const std::string& line : KittiLinesIn(times, num_frames)) {
    const std::vector<std::string_view> words = Words(line);
    const auto time_s = words.size() == 1 ? ParseNumber<double>(words[0]) : std::nullopt;
    constexpr double kMost_s = 1e9;
    if (!time_s || !(std::abs(*time_s) <= kMost_s)) {
      throw InputError(PlaceInFile(times, number) + ": must be a time in seconds");
    }
    read.times_ns.push_back(std::llround(*time_s * kNsPerS));
    ++number;
  }
  return read;
}

}  // namespace railcast
