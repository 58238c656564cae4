#include "generator/extras/insert/plan/pose_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/median.h"
#include "core/base/pose_numbers.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/text_number.h"
#include "core/base/units.h"
#include "core/io/openlabel.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/frame_record.h"
#include "core/scenario/json_text.h"
#include "railcast/remark.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMost_s = 4'500'000'000;  // Differences fit into 64 bits as ns.

constexpr std::size_t kTumNumbers = 8;

/// Whether frames of a recording can be this far apart.
bool IsFrameStep(double step_s, double most_s = kMostFrameStep_s) {
  constexpr double kLeast_s = 0.01;
  constexpr double kRounding = 1e-6;  // For times in microseconds.
  return step_s >= kLeast_s - kRounding && step_s <= most_s + kRounding;
}

std::string PlaceInFile(const fs::path& file, std::size_t line) {
  return ShownPath(file) + ":" + NumberText(line);
}

std::vector<std::string> AllLines(const fs::path& file) {
  const std::string text = ReadTextWhole(file);
  std::string_view rest = text;
  std::vector<std::string> lines;
  while (const auto line = TakeLine(rest)) lines.emplace_back(*line);
  while (!lines.empty() && Words(lines.back()).empty()) lines.pop_back();
  return lines;
}

std::vector<std::string> KittiLinesIn(const fs::path& file, std::size_t num_frames) {
  std::vector<std::string> lines = AllLines(file);
  if (lines.size() == num_frames) return lines;
  throw InputError(ShownPath(file) + ": must have a line for each of the " +
                   NumberText(num_frames) + " frames" + Got(lines.size()));
}

/// Reads the upper three rows of a pose's matrix, 12 numbers, as KITTI writes it.
/// @param place For messages: "poses.txt:3".
/// @throws InputError "poses.txt:3: must be the 12 numbers of a pose".
Transform ReadKittiPose(const std::string& line, const std::string& place) {
  constexpr std::size_t kNumbers = 12;
  constexpr double kRounding = 1e-3;
  const std::vector<std::string_view> words = Words(line);
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> rows = Eigen::Matrix<double, 3, 4>::Zero();
  for (std::size_t i = 0; i < words.size() && i < kNumbers; ++i) {
    const auto number = ParseTextNumber<double>(words[i]);
    rows.data()[i] = number.value_or(std::nan(""));
  }
  const Eigen::Matrix3d axes = rows.leftCols<3>();
  const bool is_rotation =
      (axes.transpose() * axes).isIdentity(kRounding) && axes.determinant() > 0;
  if (words.size() != kNumbers || !rows.allFinite() || !is_rotation) {
    throw InputError(place + ": must be the 12 numbers of a pose");
  }
  return MakeTransform(Eigen::Quaterniond(axes).normalized().toRotationMatrix(), rows.col(3));
}

/// The pose of the velodyne in the axes of camera 0.
std::optional<Transform> ReadCalibration(const fs::path& file) {
  if (!exists(file)) return std::nullopt;
  const std::string text = ReadTextWhole(file);
  std::string_view rest = text;
  for (std::size_t number = 1; const auto line = TakeLine(rest); ++number) {
    if (!line->starts_with("Tr:")) continue;
    return ReadKittiPose(std::string(line->substr(3)), PlaceInFile(file, number));
  }
  return std::nullopt;
}

/// Leads from one coordinate system to another.
struct Link {
  std::string to;
  Transform to_from_here;
  bool is_of_frame = false;
};

/// A time in seconds with all its digits, "1631441453.299504000", in ns.
std::optional<std::int64_t> TimeOf_ns(const std::string& text) {
  const std::size_t point = text.find('.');
  std::string fraction = point == std::string::npos ? "" : text.substr(point + 1);
  constexpr std::size_t kDigits = 9;
  const auto seconds = ParseNumber<std::int64_t>(text.substr(0, point));
  const bool is_digits = std::ranges::all_of(fraction, &IsDigit);
  if (!seconds || *seconds < 0 || *seconds > kMost_s || !is_digits || fraction.size() > kDigits) {
    return std::nullopt;
  }
  fraction.resize(kDigits, '0');
  return *seconds * kNsPerS + ParseNumber<std::int64_t>(fraction).value();
}

/// As TimeOf_ns(), or a number.
std::int64_t StampOf_ns(const Json& json, const OpenLabelPlace& place) {
  if (json.is_number() && std::abs(json.get<double>()) <= static_cast<double>(kMost_s)) {
    return std::llround(json.get<double>() * static_cast<double>(kNsPerS));
  }
  const std::string text = json.is_string() ? json.get<std::string>() : "";
  const auto time_ns = TimeOf_ns(text);
  if (!time_ns) place.Fail("must be a time in seconds");
  return *time_ns;
}

class OpenLabel {
 public:
  OpenLabel(const Json& json, const OpenLabelPlace& place, const std::string& sensor)
      : json_(OpenLabelMember(json, "openlabel", place)),
        place_(place / "openlabel"),
        sensor_(sensor) {
    const OpenLabelPlace systems_place = place_ / "coordinate_systems";
    const Json& systems = OpenLabelMember(json_, "coordinate_systems", place_);
    if (!systems.is_object() || !systems.contains(sensor)) {
      systems_place.Fail("must have that of the sensor " + Quoted(sensor));
    }
    for (const auto& [name, system] : systems.items()) {
      const OpenLabelPlace own = systems_place / name;
      const std::string parent = OpenLabelText(system, "parent", own);
      if (parent.empty() || !system.contains("pose_wrt_parent")) continue;
      parents_[name] = {parent,
                        OpenLabelTransform(system.at("pose_wrt_parent"), own / "pose_wrt_parent")};
    }
  }

  [[nodiscard]] PoseFile Read() const {
    const OpenLabelPlace frames_place = place_ / "frames";
    const Json& frames = OpenLabelMember(json_, "frames", place_);
    if (!frames.is_object()) frames_place.Fail("must be an object");
    // Their numbers are texts, and those stand in any order.
    std::map<std::int64_t, std::string> keys;
    for (const auto& [key, frame] : frames.items()) {
      const auto number = ParseNumber<std::int64_t>(key);
      if (!number) (frames_place / key).Fail("must be named by its number");
      keys[*number] = key;
    }
    PoseFile poses;
    for (const auto& [number, key] : keys) {
      const OpenLabelPlace own = frames_place / key / "frame_properties";
      const Json& properties =
          OpenLabelMember(frames.at(key), "frame_properties", frames_place / key);
      poses.world_from_sensor.push_back(PoseIn(properties, own));
      if (properties.contains("timestamp")) {
        poses.stamps_ns.push_back(StampOf_ns(properties.at("timestamp"), own / "timestamp"));
      }
    }
    if (poses.stamps_ns.size() != keys.size()) poses.stamps_ns.clear();
    return poses;
  }

 private:
  [[nodiscard]] Transform PoseIn(const Json& properties, const OpenLabelPlace& place) const {
    std::multimap<std::string, Link> links;
    if (properties.is_object() && properties.contains("transforms")) {
      for (const auto& [name, transform] : properties.at("transforms").items()) {
        const OpenLabelPlace own = place / "transforms" / name;
        const std::string from = OpenLabelText(transform, "src", own);
        const std::string to = OpenLabelText(transform, "dst", own);
        const Transform to_from = OpenLabelTransform(
            OpenLabelMember(transform, "transform_src_to_dst", own), own / "transform_src_to_dst");
        links.emplace(from, Link{to, to_from, true});
        links.emplace(to, Link{from, to_from.inverse(), true});
      }
    }
    Transform root_from_sensor = Transform::Identity();
    std::string here = sensor_;
    std::set<std::string> passed = {here};
    bool has_moving = false;
    while (const auto link = LinkFrom(here, links, passed)) {
      root_from_sensor = link->to_from_here * root_from_sensor;
      has_moving = has_moving || link->is_of_frame;
      here = link->to;
      passed.insert(here);
    }
    if (!has_moving) {
      (place / "transforms").Fail("must lead from " + Quoted(sensor_) + " to the world");
    }
    return root_from_sensor;
  }

  // The way up: a transform of the frame goes before a place that never changes.
  [[nodiscard]] std::optional<Link> LinkFrom(const std::string& here,
                                             const std::multimap<std::string, Link>& links,
                                             const std::set<std::string>& passed) const {
    const auto [begin, end] = links.equal_range(here);
    for (auto link = begin; link != end; ++link) {
      if (!passed.contains(link->second.to)) return link->second;
    }
    const auto parent = parents_.find(here);
    if (parent == parents_.end() || passed.contains(parent->second.to)) return std::nullopt;
    return parent->second;
  }

  const Json& json_;
  OpenLabelPlace place_;
  std::string sensor_;
  std::map<std::string, Link> parents_;  ///< Links of coordinate systems, by name.
};

/// Reads the poses of a sensor from a file of OpenLABEL 1.0 (ASAM, 2021): from its coordinate
/// system through those above it, by the `transforms` of a frame where there are any, else by their
/// `pose_wrt_parent`, up to one that has none.
/// @param sensor The name of its coordinate system.
/// @throws InputError "FILE: /openlabel/...: rule" if the file is none, or if no transform of a
///   frame is on the way, so that the poses are not known.
PoseFile ReadOpenLabelPoses(const std::filesystem::path& file, const std::string& sensor) {
  const OpenLabelPlace place{ShownPath(file), ""};
  const Json json = ParseOpenLabel(ReadFileWhole(file), place.file);
  return OpenLabel(json, place, sensor).Read();
}

/// Reads a line as SLAM programs write it for TUM's benchmark: time, x, y, z, qx, qy, qz, qw.
void ReadTumLine(const std::vector<std::string_view>& words,
                 const std::string& place,
                 PoseFile& poses) {
  std::vector<double> numbers;
  for (const std::string_view word : words) {
    if (const auto number = ParseTextNumber<double>(word)) numbers.push_back(*number);
  }
  if (words.size() != kTumNumbers || numbers.size() != kTumNumbers) {
    throw InputError(place + ": must be the 8 numbers of a time and a pose, as in TUM's format");
  }
  auto stamp_ns = TimeOf_ns(std::string(words[0]));
  if (!stamp_ns && std::abs(numbers[0]) <= static_cast<double>(kMost_s)) {
    stamp_ns = std::llround(numbers[0] * static_cast<double>(kNsPerS));
  }
  if (!stamp_ns) throw InputError(place + ": must be a time in seconds" + Got(numbers[0]));
  poses.stamps_ns.push_back(*stamp_ns);
  poses.world_from_sensor.push_back(
      MakePose(std::vector<double>(numbers.begin() + 1, numbers.end()), place));
}

/// Lines of KITTI's or TUM's numbers, between which comments may stand.
PoseFile ReadNumberLines(const fs::path& file) {
  PoseFile poses;
  std::size_t number = 0;
  for (const std::string& line : AllLines(file)) {
    const std::string place = PlaceInFile(file, ++number);
    const auto words = Words(line);
    if (!words.empty() && words[0].starts_with('#')) continue;
    const bool is_first = poses.world_from_sensor.empty();
    if (is_first && line.find(',') != std::string::npos) {
      throw InputError(place + ": numbers must be separated by blanks");
    }
    if (is_first ? words.size() == kTumNumbers : !poses.stamps_ns.empty()) {
      ReadTumLine(words, place, poses);
    } else {
      poses.world_from_sensor.push_back(ReadKittiPose(line, place));
    }
  }
  return poses;
}

/// What a time would be if its unit were another one, so that frames are this far apart.
std::string OtherUnit(double step_s) {
  struct Unit {
    double factor;
    std::string_view name;
  };
  constexpr auto kUnits = std::to_array<Unit>({{1e3, "microseconds"},
                                               {1e6, "milliseconds"},
                                               {1e9, "seconds"},
                                               {1e-3, "milliseconds"},
                                               {1e-6, "microseconds"},
                                               {1e-9, "nanoseconds"}});
  for (const Unit& unit : kUnits) {
    if (IsFrameStep(step_s * unit.factor)) return ": are they " + std::string(unit.name) + "?";
  }
  return "";
}

/// Checks that times are those of frames, and returns their median step.
std::int64_t CheckSteps(const std::vector<std::int64_t>& stamps_ns,
                        const std::string& place,
                        double most_step_s = kMostFrameStep_s) {
  std::vector<std::int64_t> steps_ns;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    steps_ns.push_back(stamps_ns[i] - stamps_ns[i - 1]);
  }
  if (steps_ns.empty()) return 0;
  const std::int64_t median_ns = MedianOf(steps_ns);
  const double step_s = SecondsFromNs(median_ns);
  if (IsFrameStep(step_s, most_step_s)) {
    const std::int64_t least_ns = *std::ranges::min_element(steps_ns);
    if (least_ns > 0) return median_ns;
    throw InputError(place + ": times: each must be after the one before it (got " +
                     ShortText(SecondsFromNs(least_ns)) + " s after it)");
  }
  const std::string steps =
      std::isfinite(most_step_s) ? "0.01 to " + ShortText(most_step_s) : "at least 0.01";
  throw InputError(place + ": times: must be " + steps + " s apart in the median (got " +
                   ShortText(step_s) + " s)" + OtherUnit(step_s));
}

/// Checks the times of a file's poses, if it has any, and the speed over the whole way; takes their
/// step.
void CheckTimes(const std::string& place, double most_step_s, PoseFile& poses) {
  if (poses.stamps_ns.empty()) return;
  poses.step_ns = CheckSteps(poses.stamps_ns, place, most_step_s);
  double length_m = 0.0;
  for (std::size_t i = 1; i < poses.world_from_sensor.size(); ++i) {
    length_m +=
        (poses.world_from_sensor[i].translation() - poses.world_from_sensor[i - 1].translation())
            .norm();
  }
  CheckSpeed(length_m, SecondsFromNs(poses.stamps_ns.back() - poses.stamps_ns.front()), place);
}

/// Checks that z points up: no railway climbs as a camera's z axis, which points ahead, does.
void CheckAxes(const std::string& place, const std::vector<Transform>& world_from_sensor) {
  if (world_from_sensor.empty()) return;
  const Eigen::Vector3d first_m = world_from_sensor.front().translation();
  Eigen::Vector3d way_m = Eigen::Vector3d::Zero();  // To the farthest pose.
  std::size_t num_overturned = 0;
  for (const Transform& pose : world_from_sensor) {
    const Eigen::Vector3d from_first_m = pose.translation() - first_m;
    if (from_first_m.norm() > way_m.norm()) way_m = from_first_m;
    num_overturned += pose.linear()(2, 2) < 0.0 ? 1 : 0;
  }
  constexpr double kLeastWay_m = 5.0;
  constexpr double kMostClimb = 0.5;
  if (way_m.norm() >= kLeastWay_m && std::abs(way_m.z()) > kMostClimb * way_m.norm()) {
    throw InputError(place + ": poses: must not climb more than 1 m in 2 m (got " +
                     ShortText(way_m.z()) + " m in " + ShortText(way_m.norm()) +
                     " m): are the axes those of a camera?");
  }
  if (num_overturned == 0) return;
  Publish({.kind = RemarkKind::kPosesOverturned, .place = place, .number = num_overturned});
}

PoseFile ReadCsv(const fs::path& file) {
  const std::string text = ReadTextWhole(file);
  std::string_view rest = text;
  const auto header = TakeLine(rest);
  if (!header || std::string(*header) + "\n" != kPosesHeader) {
    throw InputError(ShownPath(file) + ":1: must be " +
                     std::string(kPosesHeader.substr(0, kPosesHeader.size() - 1)) + " (got " +
                     ShownText(std::string(header.value_or(""))) + ")");
  }
  PoseFile poses;
  for (std::size_t number = 2; const auto line = TakeLine(rest); ++number) {
    if (line->empty() && rest.find_first_not_of("\r\n") == std::string_view::npos) break;
    const std::string place = PlaceInFile(file, number);
    const std::string_view word = line->substr(0, line->find(','));
    const auto stamp_ns = ParseTextNumber<std::int64_t>(word);
    constexpr std::int64_t kMost_ns = kMost_s * kNsPerS;
    if (!stamp_ns || *stamp_ns < -kMost_ns || *stamp_ns > kMost_ns) {
      throw InputError(place + ": stamp_ns: must be a whole number of at most 4.5e18 (got " +
                       ShownText(std::string(word)) + ")");
    }
    poses.world_from_sensor.push_back(ReadPoseLine(*line, *stamp_ns, place));
    poses.stamps_ns.push_back(*stamp_ns);
  }
  return poses;
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
  if (exists(poses) && !camera_from_sensor) {
    Publish(
        {.kind = RemarkKind::kFilesLeftOut,
         .place = ShownPath(poses),
         .detail = "calib.txt beside it must have Tr, the sensor's pose in the axes of camera 0"});
  }
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
    const auto time_s = words.size() == 1 ? ParseTextNumber<double>(words[0]) : std::nullopt;
    constexpr double kMost_s = 1e9;
    if (!time_s || !(std::abs(*time_s) <= kMost_s)) {
      throw InputError(PlaceInFile(times, number) + ": must be a time in seconds");
    }
    read.times_ns.push_back(std::llround(*time_s * kNsPerS));
    ++number;
  }
  CheckSteps(read.times_ns, ShownPath(times));
  return read;
}

PoseFile ReadPoseFile(const fs::path& file, const std::string& sensor, double most_step_s) {
  const std::string extension = LowerCase(file.extension().string());
  PoseFile poses = extension == ".csv"    ? ReadCsv(file)
                   : extension == ".json" ? ReadOpenLabelPoses(file, sensor)
                                          : ReadNumberLines(file);
  CheckTimes(ShownPath(file), most_step_s, poses);
  CheckAxes(ShownPath(file), poses.world_from_sensor);
  return poses;
}

void CheckFrameStamps(const PoseFile& poses,
                      const std::vector<FrameStamp>& frames,
                      const std::string& place) {
  if (poses.stamps_ns.empty() || frames.empty()) return;
  const FrameStamp& first = frames.front();
  const bool has_times = std::ranges::any_of(
      frames, [&](const FrameStamp& frame) { return frame.stamp_ns != first.stamp_ns; });
  if (!has_times) return;
  const auto seconds = [](std::int64_t to_ns, std::int64_t from_ns) {
    return (static_cast<double>(to_ns) - static_cast<double>(from_ns)) / kNsPerS;
  };
  const std::int64_t first_ns = poses.stamps_ns.at(first.frame);
  const double half_step_s = SecondsFromNs(poses.step_ns) / 2.0;
  for (const auto& [frame, stamp_ns] : frames) {
    const double pose_s = seconds(poses.stamps_ns.at(frame), first_ns);
    const double frame_s = seconds(stamp_ns, first.stamp_ns);
    if (std::abs(pose_s - frame_s) <= half_step_s) continue;
    throw InputError(place +
                     ": times: must be as long after the first as those of the frames (got " +
                     ShortText(pose_s) + " s for frame " + NumberText(frame) +
                     ", which came after " + ShortText(frame_s) + " s)");
  }
  if (std::abs(seconds(first.stamp_ns, first_ns)) <= half_step_s) return;
  Publish({.kind = RemarkKind::kTimesRelative, .place = place, .number = poses.stamps_ns.size()});
}

void CheckSpeed(double length_m, double time_s, const std::string& place) {
  constexpr double kNoise_m = 1.0;
  if (length_m <= kMostSpeed_mps * time_s + kNoise_m) return;
  throw InputError(place + ": poses: must not be faster than 150 m/s over the whole way (got " +
                   ShortText(length_m) + " m in " + ShortText(time_s) + " s)");
}

}  // namespace railcast
