#include "core/io/run/frame_record.h"

#include <nlohmann/json.hpp>

#include <array>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/strict_json.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

Json ScanPoseJson(const RecordedScanPose& pose) {
  const Vector3& position_m = pose.position_m;
  const Eigen::Quaterniond& turn = pose.rotation;
  return {{"time_ns", pose.time_ns},
          {"position_m", {position_m.x(), position_m.y(), position_m.z()}},
          {"quaternion_xyzw", {turn.x(), turn.y(), turn.z(), turn.w()}}};
}

RecordedScanPose ParseScanPose(const StrictJson& pose) {
  const auto position_m = pose.at("position_m").get<std::array<double, 3>>();
  const auto turn = pose.at("quaternion_xyzw").get<std::array<double, 4>>();
  return {pose.at("time_ns").get<std::uint32_t>(),
          Vector3(position_m[0], position_m[1], position_m[2]),
          Eigen::Quaterniond(turn[3], turn[0], turn[1], turn[2])};
}

FrameRecord Parse(const StrictJson& line) {
  FrameRecord record;
  record.frame = line.at("frame").get<std::uint32_t>();
  record.stamp_ns = line.at("stamp_ns").get<std::int64_t>();
  for (const StrictJson& pose : line.at("scan_poses")) {
    record.scan_poses.push_back(ParseScanPose(pose));
  }
  for (const StrictJson& file : line.at("files")) {
    record.files.push_back({file.at("name").get<std::string>(),
                            file.at("bytes").get<std::uint64_t>(),
                            file.at("xxh3").get<std::string>()});
  }
  record.records_hash = line.at("records_xxh3").get<std::string>();
  if (line.contains("motion_lines")) line.at("motion_lines").get_to(record.motion_lines);
  if (line.contains("clouds_xxh3")) record.clouds_hash = line.at("clouds_xxh3").get<std::string>();
  record.counts.points = line.at("points").get<std::uint64_t>();
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    record.counts.outcomes[i] =
        line.at("outcomes").at(std::string(kOutcomeNames[i])).get<std::uint64_t>();
  }
  record.counts.points_per_label =
      line.at("points_per_label").get<std::map<std::string, std::uint64_t>>();
  return record;
}

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

PoseRecord ParsePoseLine(std::string_view line) {
  const auto take = [&line] {
    const std::size_t end = line.find_first_of(",\n");
    Check(end != std::string_view::npos, "a line of poses.csv has eight numbers");
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(end + 1);
    return word;
  };
  PoseRecord pose;
  const auto stamp = ParseNumber<std::int64_t>(take());
  Check(stamp.has_value(), "poses.csv begins with the stamp");
  pose.stamp_ns = *stamp;
  std::array<double, 7> values{};
  for (double& value : values) {
    const auto number = ParseNumber<double>(take());
    Check(number.has_value(), "poses.csv holds numbers");
    value = *number;
  }
  pose.position_m = Vector3(values[0], values[1], values[2]);
  pose.rotation = Eigen::Quaterniond(values[6], values[3], values[4], values[5]);
  return pose;
}

void PutCounts(const FrameCounts& counts, nlohmann::ordered_json& object) {
  nlohmann::ordered_json outcomes = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    outcomes[std::string(kOutcomeNames[i])] = counts.outcomes[i];
  }
  object["points"] = counts.points;
  object["outcomes"] = outcomes;
  object["points_per_label"] = counts.points_per_label;
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

nlohmann::ordered_json ScanPosesJson(const std::vector<RecordedScanPose>& poses) {
  Json json = Json::array();
  for (const RecordedScanPose& pose : poses) json.push_back(ScanPoseJson(pose));
  return json;
}

std::string FrameRecordLine(const FrameRecord& record) {
  Json files = Json::array();
  for (const WrittenFile& file : record.files) {
    files.push_back({{"name", file.name}, {"bytes", file.size}, {"xxh3", file.hash}});
  }
  Json line = {{"frame", record.frame},
               {"stamp_ns", record.stamp_ns},
               {"scan_poses", ScanPosesJson(record.scan_poses)},
               {"files", files},
               {"records_xxh3", record.records_hash}};
  if (!record.motion_lines.empty()) line["motion_lines"] = record.motion_lines;
  if (!record.clouds_hash.empty()) line["clouds_xxh3"] = record.clouds_hash;
  PutCounts(record.counts, line);
  return WithLineHash(line.dump()) + "\n";
}

std::optional<FrameRecord> ParseFrameLine(std::string_view line) {
  if (line.ends_with('\n')) line.remove_suffix(1);
  if (!LineHashFault(line).empty()) return std::nullopt;
  try {
    return Parse(StrictJson::parse(line));
  } catch (const StrictJson::exception&) {
    return std::nullopt;
  }
}

}  // namespace railcast
