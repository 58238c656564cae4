#include "core/io/recording/sequence_lines.h"

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/kitti.h"
#include "core/io/strict_json.h"

namespace railcast {
namespace {

Transform PoseOf(const StrictJson& position_m,
                 const StrictJson& quaternion,
                 const std::string& place) {
  auto numbers = position_m.get<std::vector<double>>();
  const auto turn = quaternion.get<std::vector<double>>();
  numbers.insert(numbers.end(), turn.begin(), turn.end());
  return MakePose(numbers, place);
}

ScanPose ScanPoseOf(const StrictJson& json, const std::string& place) {
  return {json.at("time_ns"), PoseOf(json.at("position_m"), json.at("quaternion_xyzw"), place)};
}

void ReadScanPoses(const StrictJson& json, const std::string& place, std::vector<ScanPose>& poses) {
  for (const StrictJson& each : json) {
    const ScanPose pose = ScanPoseOf(each, place);
    if (!poses.empty() && pose.time_ns <= poses.back().time_ns) {
      throw InputError({{place + ": /scan_poses/" + std::to_string(poses.size()) + "/time_ns",
                         "must be > that before, " + NumberText(poses.back().time_ns),
                         NumberText(pose.time_ns)}});
    }
    poses.push_back(pose);
  }
  if (poses.empty()) throw InputError({{place + ": /scan_poses", "must not be empty", ""}});
}

Vector3 VectorOf(const StrictJson& json) {
  const auto numbers = json.get<std::array<double, 3>>();
  return {numbers[0], numbers[1], numbers[2]};
}

RecordedObject ObjectOf(const StrictJson& json, const std::string& place, std::size_t index) {
  RecordedObject object{
      .name = json.at("name"),
      .type = json.at("type"),
      .label = json.at("label"),
      .instance = json.at("instance"),
      .points = json.at("points"),
      .firings_visible = json.at("firings_visible"),
      .firings_alone = json.at("firings_alone"),
      .occlusion = ReadOcclusion(json, place + ": /objects/" + std::to_string(index))};
  // Older programs did not write it.
  if (const auto time = json.find("points_time_ns"); time != json.end() && !time->is_null()) {
    object.points_time_ns = time->get<std::uint32_t>();
  }
  const StrictJson& box = json.at("sensor");
  object.size_m = VectorOf(box.at("size_m"));
  object.sensor_from_box = PoseOf(box.at("center_m"), box.at("quaternion_xyzw"), place);
  object.velocity_world_mps = VectorOf(json.at("velocity_mps"));
  return object;
}

}  // namespace

std::optional<double> ReadOcclusion(const StrictJson& object, const std::string& place) {
  const std::uint32_t visible = object.at("firings_visible");
  const std::uint32_t alone = object.at("firings_alone");
  if (visible > alone) {
    throw InputError({{place + "/firings_visible", "must be <= firings_alone, " + NumberText(alone),
                       NumberText(visible)}});
  }
  const StrictJson& occlusion = object.at("occlusion");
  const auto must_be = [&](const std::string& rule) {
    return InputError({{place + "/occlusion", "must be " + rule, ShownText(occlusion.dump())}});
  };
  if (alone == 0) {
    if (!occlusion.is_null()) throw must_be("null, as no firing would meet the object even alone");
    return std::nullopt;
  }
  if (!occlusion.is_number()) throw must_be("a number");
  const auto hidden = occlusion.get<double>();
  if (!(hidden >= 0.0 && hidden <= 1.0)) throw must_be("from 0 to 1");
  return hidden;
}

Transform MakePose(const std::vector<double>& numbers, const std::string& place) {
  if (numbers.size() != 7) {
    throw InputError(place + ": a pose must have seven numbers (got " + NumberText(numbers.size()) +
                     ")");
  }
  for (const double number : numbers) {
    if (!std::isfinite(number)) throw InputError(place + ": a pose must be finite");
  }
  const Eigen::Quaterniond turn(numbers[6], numbers[3], numbers[4], numbers[5]);
  constexpr double kTolerance = 1e-3;
  if (std::abs(turn.norm() - 1.0) > kTolerance) {
    throw InputError(place + ": a quaternion must have length 1 (got " + NumberText(turn.norm()) +
                     ")");
  }
  return MakeTransform(turn.normalized().toRotationMatrix(),
                       Vector3(numbers[0], numbers[1], numbers[2]));
}

FrameLine ReadFrameLine(const std::string& line, const std::string& place) {
  return ReadRecordedJson<StrictJson>(line, place, [&](const StrictJson& json) {
    FrameLine result{.frame = json.at("frame"),
                     .stamp_ns = json.at("stamp_ns"),
                     .scan_poses = {},
                     .files = {},
                     .records_hash = json.at("records_xxh3")};
    if (json.contains("scan_end")) {
      result.scan_poses.push_back(ScanPoseOf(json.at("scan_end"), place));
    } else {
      ReadScanPoses(json.at("scan_poses"), place, result.scan_poses);
    }
    for (const StrictJson& file : json.at("files")) {
      result.files.push_back({file.at("name"), file.at("xxh3"), file.at("bytes")});
    }
    if (json.contains("motion_lines")) json.at("motion_lines").get_to(result.motion_lines);
    result.clouds_hash = json.value("clouds_xxh3", "");
    return result;
  });
}

Transform ReadPoseLine(std::string_view line, std::int64_t stamp_ns, const std::string& place) {
  std::vector<double> numbers;
  bool is_stamp = true;
  while (!line.empty()) {
    const std::size_t end = line.find(',');
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
    if (is_stamp) {
      const auto stamp = ParseNumber<std::int64_t>(word);
      if (stamp != stamp_ns) {
        throw InputError(place + ": stamp_ns: must be " + NumberText(stamp_ns) +
                         ", as in frames.jsonl or insert.jsonl (got " + ShownText(word) + ")");
      }
      is_stamp = false;
      continue;
    }
    const auto number = ParseNumber<double>(word);
    if (!number) throw InputError(place + ": must be numbers (got " + ShownText(word) + ")");
    numbers.push_back(*number);
  }
  return MakePose(numbers, place);
}

std::string KittiClassOf(const RecordedObject& object,
                         const LabelTable& labels,
                         const LabelTable& kitti) {
  const Label* const label = labels.Find(object.label);
  if (label == nullptr) return object.label;
  const std::uint16_t standing = label->semantic_kitti;
  const Label* const kitti_class =
      kitti.Find(IsMoving(object.velocity_world_mps) ? MovingSemanticKitti(standing) : standing);
  return kitti_class == nullptr ? object.label : kitti_class->name;
}

std::vector<RecordedObject> ReadObjectsLine(const std::string& line,
                                            std::uint32_t frame,
                                            const std::string& place) {
  return ReadRecordedJson<StrictJson>(line, place, [&](const StrictJson& json) {
    const std::uint32_t got = json.at("frame");
    if (got != frame) {
      throw InputError(place + ": frame: must be " + NumberText(frame) +
                       ", as in frames.jsonl or insert.jsonl (got " + NumberText(got) + ")");
    }
    std::vector<RecordedObject> objects;
    for (const StrictJson& object : json.at("objects")) {
      objects.push_back(ObjectOf(object, place, objects.size()));
    }
    return objects;
  });
}

}  // namespace railcast
