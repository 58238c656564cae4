#include "core/io/run/frame_record.h"

#include <array>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/base/pose_numbers.h"
#include "core/base/text.h"
#include "core/base/text_number.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/scenario/archive.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

// What the counts of kOutcomeNames mean.
constexpr std::array<KeyDoc, kOutcomeNames.size()> kOutcomeDocs = {
    "Firings of which a surface returned an echo.",
    "Firings without a surface within range_max_m.",
    "Firings whose measured range is beyond the sensor's range gate.",
    "Firings whose received power is below the detection threshold.",
    "Firings that rain absorbed on the way.",
    "Firings with an echo of rain, snow, fog, a mirror image or the sensor itself.",
    "Firings that a surface nearer than range_min_m blocked.",
    "Firings that the vehicle's own body blocked.",
    "Firings of which the sensor missed the pulse.",
    "None: only second and later slots of a firing have this outcome.",
    "Firings lost to drops, dirt or snow on the sensor's window.",
};

}  // namespace

Eigen::Quaterniond CanonicalRotation(const Transform& transform) {
  Eigen::Quaterniond rotation(transform.linear());
  if (rotation.w() < 0.0) rotation.coeffs() = -rotation.coeffs();
  return rotation;
}

PoseRecord::PoseRecord(std::int64_t stamp, const Transform& world_from_sensor)
    : stamp_ns(stamp),
      position_m(world_from_sensor.translation()),
      rotation(CanonicalRotation(world_from_sensor)) {}

Transform PoseRecord::WorldFromSensor() const {
  return MakeTransform(rotation.toRotationMatrix(), position_m);
}

std::string PoseLine(const PoseRecord& pose) {
  std::string line = NumberText(pose.stamp_ns);
  for (const double value :
       {pose.position_m.x(), pose.position_m.y(), pose.position_m.z(), pose.rotation.x(),
        pose.rotation.y(), pose.rotation.z(), pose.rotation.w()}) {
    line += ',';
    line += NumberText(value);
  }
  return line + "\n";
}

void DescribeRotation(Archive& a, Eigen::Quaterniond& rotation) {
  a.Required("quaternion_xyzw", rotation, "Rotation from these axes to those around them.");
  a.Ensure({"quaternion_xyzw"}, IsUnit(rotation), "must have length 1");
}

PoseRecord ReadPoseRecord(std::string_view line, const std::string& place) {
  if (line.ends_with('\n')) line.remove_suffix(1);
  const auto take = [&line] {
    const std::size_t end = line.find(',');
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
    return word;
  };
  PoseRecord pose;
  const std::string_view first = take();
  const auto stamp_ns = ParseTextNumber<std::int64_t>(first);
  if (!stamp_ns) {
    throw InputError(place + ": stamp_ns: must be a whole number (got " + ShownText(first) + ")");
  }
  pose.stamp_ns = *stamp_ns;
  std::vector<double> numbers;
  while (!line.empty()) {
    const std::string_view word = take();
    const auto number = ParseTextNumber<double>(word);
    if (!number) throw InputError(place + ": must be numbers (got " + ShownText(word) + ")");
    numbers.push_back(*number);
  }
  (void)MakePose(numbers, place);
  pose.position_m = Vector3(numbers[0], numbers[1], numbers[2]);
  pose.rotation = Eigen::Quaterniond(numbers[6], numbers[3], numbers[4], numbers[5]);
  return pose;
}

Transform ReadPoseLine(std::string_view line, std::int64_t stamp_ns, const std::string& place) {
  const PoseRecord pose = ReadPoseRecord(line, place);
  if (pose.stamp_ns != stamp_ns) {
    throw InputError(place + ": stamp_ns: must be " + NumberText(stamp_ns) +
                     ", as in frames.jsonl or insert.jsonl" + Got(pose.stamp_ns));
  }
  return MakeTransform(pose.rotation.normalized().toRotationMatrix(), pose.position_m);
}

void Describe(Archive& a, OutcomeCounts& s) {
  for (std::size_t i = 0; i < s.size(); ++i) {
    a.Required(kOutcomeNames[i], s[i], kOutcomeDocs[i]);
  }
}

void Describe(Archive& a, FrameCounts& s) {
  a.Required("points", s.points, "Number of slots with a point.");
  a.Required("outcomes", s.outcomes, "Number of firings with each outcome.");
  a.Required("points_per_label", s.points_per_label,
             "Number of points with each label that has any.");
}

void DescribeKnown(Archive& a, FrameCounts& s) {
  std::optional<OutcomeCounts> outcomes;
  std::optional<std::map<std::string, std::uint64_t>> points_per_label;
  if (s.outcomes != OutcomeCounts()) {
    outcomes = s.outcomes;
    points_per_label = s.points_per_label;
  }
  a.Required("points", s.points, "Number of slots with a point.");
  a.Optional("outcomes", outcomes, "Number of firings with each outcome, where they are known.");
  a.Optional("points_per_label", points_per_label,
             "Number of points with each label; known with the outcomes.");
  if (outcomes) s.outcomes = *outcomes;
  if (points_per_label) s.points_per_label = *std::move(points_per_label);
}

void FrameCounts::Add(const FrameCounts& other) {
  points += other.points;
  for (std::size_t i = 0; i < outcomes.size(); ++i) outcomes[i] += other.outcomes[i];
  for (const auto& [label, count] : other.points_per_label) points_per_label[label] += count;
}

FrameCounts CountFrame(const Frame& frame, const LabelTable& labels) {
  FrameCounts counts;
  std::map<std::uint32_t, std::uint64_t> points_per_id;
  // Neighbouring points mostly have the same label.
  std::uint32_t last_id = 0;
  std::uint64_t* num_of_last = nullptr;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const Outcome outcome = frame.outcome[slot];
    // The outcome of a firing is that of its first slot; the others only say whether they hold a
    // further return.
    if (slot % frame.returns == 0) ++counts.outcomes[static_cast<std::size_t>(outcome)];
    if (!HasPoint(outcome)) continue;
    ++counts.points;
    const std::uint32_t id = frame.label[slot];
    if (num_of_last == nullptr || id != last_id) num_of_last = &points_per_id[id];
    last_id = id;
    ++*num_of_last;
  }
  for (const auto& [id, count] : points_per_id) {
    const Label* label = labels.Find(id);
    Check(label != nullptr, "a frame's labels are in its label table");
    counts.points_per_label[label->name] = count;
  }
  return counts;
}

std::vector<KnownFile> KnownFilesOf(const std::vector<FrameFile>& files) {
  std::vector<KnownFile> known;
  for (const FrameFile& file : files) {
    known.push_back({file.name, ContentHash(file.bytes), file.bytes.size()});
  }
  return known;
}

std::vector<RecordedScanPose> ScanPosesOf(const Frame& frame) {
  std::vector<RecordedScanPose> poses;
  Eigen::Quaterniond before = CanonicalRotation(frame.world_from_sensor);
  const auto add = [&](const ScanPose& pose) {
    Eigen::Quaterniond rotation(pose.world_from_sensor.linear());
    if (rotation.dot(before) < 0.0) rotation.coeffs() = -rotation.coeffs();
    poses.push_back({pose.time_ns, pose.world_from_sensor.translation(), rotation});
    before = rotation;
  };
  for (const ScanPose& pose : frame.poses_between) add(pose);
  add({frame.duration_ns, frame.world_from_sensor_end});
  return poses;
}

std::vector<ScanPose> ScanPosesOf(const std::vector<RecordedScanPose>& poses) {
  std::vector<ScanPose> result;
  for (const RecordedScanPose& pose : poses) {
    result.push_back({pose.time_ns, MakeTransform(pose.rotation.normalized().toRotationMatrix(),
                                                  pose.position_m)});
  }
  return result;
}

void Describe(Archive& a, RecordedScanPose& s) {
  a.Required("time_ns", s.time_ns, "Time since the frame's stamp.");
  a.Required("position_m", s.position_m, "Position in the world.");
  DescribeRotation(a, s.rotation);
}

void Describe(Archive& a, FrameRecord& s) {
  a.Required("frame", s.frame, "Number of the frame.");
  a.Required("stamp_ns", s.stamp_ns, "Simulation time of the frame.");
  a.Required("scan_poses", s.scan_poses,
             "The sensor's poses after the stamp, of which the last is that of the last firing.",
             NonEmptyList());
  a.Required("files", s.files, "The frame's files.");
  a.Required("records_xxh3", s.records_hash, "Hash of the frame's lines in the other line files.");
  a.Optional("motion_lines", s.motion_lines,
             "How many lines of each motion sensor's file belong to the frame.");
  a.Optional("clouds_xxh3", s.clouds_hash,
             "Hash of its clouds in the run's bag, or of its message in the trace.");
  Describe(a, s.counts);
  a.Optional("certificate", s.certificate, "What is known of the frame's numerical error.");
}

void CheckTimes(const std::vector<RecordedScanPose>& poses, const std::string& place) {
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const std::uint32_t before_ns = poses[i - 1].time_ns;
    if (poses[i].time_ns > before_ns) continue;
    throw InputError(
        {{place + ": /scan_poses/" + std::to_string(i) + "/time_ns",
          "must be > that before, " + NumberText(before_ns), NumberText(poses[i].time_ns)}});
  }
}

FrameRecord ReadFrameLine(std::string_view line, const std::string& place) {
  auto record = ReadRecordLine<FrameRecord>(line, place);
  CheckTimes(record.scan_poses, place);
  return record;
}

std::optional<FrameRecord> ParseFrameLine(std::string_view line) {
  return ReadWholeLine(line, [](std::string_view whole) { return ReadFrameLine(whole, ""); });
}

}  // namespace railcast
