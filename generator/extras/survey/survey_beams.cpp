#include "generator/extras/survey/survey_beams.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/las_reader.h"
#include "core/io/cloud/scan_motion.h"
#include "core/io/recording/recorded_motion.h"
#include "generator/extras/insert/plan/pose_file.h"

namespace railcast {
namespace {

/// Things that are in no scene: what the air sends back, and the vehicle itself.
constexpr double kLeastRange_m = 0.5;

constexpr std::uint32_t kUnclassified = 1;

Transform BodyOf(const RecordedFrame& recorded, const RecordingInfo& info) {
  const Transform& world_from_sensor = recorded.frame.world_from_sensor;
  if (!info.scenario) return world_from_sensor;
  return world_from_sensor * VehicleFromSensor(info.scenario->lidar.mount).inverse();
}

/// Whether it is a recording in LAS, which has classes of its own.
bool IsOfAsprs(const RecordingInfo& info) {
  const Label* const label = info.labels.Find(kUnclassified);
  return label != nullptr && label->name == "unclassified";
}

bool HasReflectances(const RecordingInfo& info) {
  return info.origin || info.kind.starts_with("capture");
}

double WhiteIntensity(const RecordingInfo& info, const SurveySource& source) {
  if (source.white_intensity) return *source.white_intensity;
  return HasReflectances(info) ? 1.0 : source.guessed_white;
}

/// Reads the frames that the source names of each of its recordings. Returns how many the recording
/// has, if it was read to its end.
std::optional<std::uint32_t> ReadNamed(
    Recording& recording,
    const SurveySource& source,
    const std::function<void(std::uint32_t index, RecordedFrame frame)>& take) {
  std::uint32_t index = 0;
  for (; const auto read = recording.Next(); ++index) {
    if (index < source.first_frame || (index - source.first_frame) % source.stride != 0) continue;
    if (source.num_frames && (index - source.first_frame) / source.stride >= *source.num_frames) {
      return std::nullopt;
    }
    take(index, (*read)());
  }
  return index;
}

std::uint16_t RecordedLabelOf(std::uint32_t id, const RecordingInfo& info, SurveyLabels& labels) {
  if (info.has_kitti_labels) {
    const auto& known = info.labels.labels();
    const auto found = std::ranges::find(known, id, &Label::semantic_kitti);
    if (id == 0) return SurveyLabels::kUnknown;
    return found == known.end() ? SurveyLabels::kObject : labels.IndexOf(found->name);
  }
  if (id == 0) return SurveyLabels::kUnknown;
  const Label* const label = info.labels.Find(id);
  if (label == nullptr) return SurveyLabels::kObject;
  if (IsOfAsprs(info) && id == kUnclassified) return SurveyLabels::kUnknown;
  const std::string name(IsOfAsprs(info) ? ScenarioLabelOf(label->name) : label->name);
  return name.empty() ? SurveyLabels::kObject : labels.IndexOf(name);
}

/// The poses of a file beside a recording, if there is one.
class PosesBeside {
 public:
  explicit PosesBeside(const SurveySource& source) : file_(source.poses) {
    if (file_.empty()) return;
    poses_ = ReadPoseFile(file_, "lidar", std::numeric_limits<double>::infinity());
    if (source.recordings.size() != 1) {
      throw InputError("--poses: must belong to one recording" + Got(source.recordings.size()));
    }
  }
  void Give(std::size_t index, RecordedFrame& recorded) {
    if (file_.empty()) return;
    if (index >= poses_.world_from_sensor.size()) Refuse("more frames");
    const FrameStamp time{index, recorded.frame.stamp_ns};
    if (!first_) first_ = time;
    CheckFrameStamps(poses_, {*first_, time}, ShownPath(file_));
    recorded.frame.world_from_sensor = poses_.world_from_sensor[index];
    recorded.has_pose = true;
  }
  /// Checks the number of frames of a recording that has ended.
  void CheckNumber(std::size_t num_frames) const {
    if (!file_.empty() && num_frames != poses_.world_from_sensor.size()) {
      Refuse(std::to_string(num_frames) + " frames");
    }
  }

 private:
  void Refuse(const std::string& frames) const {
    throw InputError(ShownPath(file_) + ": must have a pose for each frame (got " +
                     std::to_string(poses_.world_from_sensor.size()) + " poses and " + frames +
                     ")");
  }
  std::filesystem::path file_;
  PoseFile poses_;
  std::optional<FrameStamp> first_;
};

}  // namespace

std::uint16_t SurveyLabels::IndexOf(const std::string& name) {
  const auto index = std::ranges::find(names_, name) - names_.begin();
  if (index == std::ssize(names_)) names_.push_back(name);
  return static_cast<std::uint16_t>(index);
}

std::optional<double> GuessWhite(const SurveySource& source) {
  if (source.white_intensity) return std::nullopt;
  std::optional<double> white;
  for (const std::filesystem::path& path : source.recordings) {
    const auto recording = OpenRecording(path);
    const RecordingInfo& info = recording->info();
    if (HasReflectances(info)) continue;
    ReadNamed(*recording, source, [&](std::uint32_t /*index*/, const RecordedFrame& recorded) {
      if (!recorded.Has("intensity")) return;
      for (const float value : recorded.frame.intensity) {
        const double least = IsOfAsprs(info) && value > 255.0F ? 65535.0
                             : value > 1.0F                    ? 255.0
                                                               : 1.0;
        white = std::max(white.value_or(1.0), least);
      }
    });
  }
  return white;
}

SurveyFrame BeamsOf(const RecordedFrame& recorded,
                    const RecordingInfo& info,
                    const SurveySource& source,
                    SurveyLabels& labels) {
  const Frame& frame = recorded.frame;
  if (!recorded.has_pose && !source.is_standing && !source.is_in_world) {
    throw InputError(
        ShownPath(recorded.name) +
        ": has no pose; must be given with --poses, with --standing if the sensor did not move, or "
        "with --world-axes if the points are in the world's axes");
  }
  SurveyFrame beams;
  beams.world_from_body = BodyOf(recorded, info);
  beams.has_vehicle = info.scenario.has_value();
  beams.has_origins = recorded.has_pose || source.is_standing;
  const ScanMotion motion(frame);
  const bool has_motion = KnowsMotion(recorded);
  const double white = WhiteIntensity(info, source);
  const bool has_intensity = recorded.Has("intensity");
  const bool has_outcome = recorded.Has("outcome");
  const bool has_label = recorded.Has("label");
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (!std::isfinite(frame.x[i])) continue;
    if (has_outcome && frame.outcome[i] != Outcome::kReturned) continue;
    const Vector3 measured_m(frame.x[i], frame.y[i], frame.z[i]);
    const double range_m = measured_m.norm();
    if (beams.has_origins && !(range_m >= kLeastRange_m && range_m <= source.range_max_m)) continue;
    SurveyBeam& beam = beams.beams.emplace_back();
    const auto in_world = [&](const Vector3& sensor_m) {
      if (!beams.has_origins) return Vector3(sensor_m + recorded.origin_m);
      return Vector3(frame.world_from_sensor *
                     (has_motion ? motion.AtStamp(sensor_m, frame.time_ns[i]) : sensor_m));
    };
    beam.point_m = in_world(measured_m);
    if (beams.has_origins) beam.origin_m = in_world(Vector3::Zero());
    beam.reflectance = has_intensity ? static_cast<float>(double{frame.intensity[i]} / white)
                                     : std::numeric_limits<float>::quiet_NaN();
    beam.label = has_label ? RecordedLabelOf(frame.label[i], info, labels) : SurveyLabels::kUnknown;
  }
  return beams;
}

void VisitFrames(const SurveySource& source,
                 SurveyLabels& labels,
                 const std::function<void(const SurveyFrame& frame)>& visit) {
  PosesBeside poses(source);
  std::size_t num_visited = 0;
  for (const std::filesystem::path& path : source.recordings) {
    const auto recording = OpenRecording(path);
    const auto num_frames =
        ReadNamed(*recording, source, [&](std::uint32_t index, RecordedFrame recorded) {
          poses.Give(index, recorded);
          visit(BeamsOf(recorded, recording->info(), source, labels));
          ++num_visited;
        });
    if (num_frames) poses.CheckNumber(*num_frames);
  }
  if (num_visited == 0) {
    throw InputError("--start-frame: must be a frame of the recording" + Got(source.first_frame));
  }
}

}  // namespace railcast
