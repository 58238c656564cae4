#include "generator/extras/insert/plan/recorded_way.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/recording/sequence_lines.h"
#include "core/points/point_alignment.h"
#include "core/rail/catenary/catenary.h"
#include "generator/extras/insert/plan/pose_file.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Poses that were estimated from clouds alone.
struct RegisteredPoses {
  std::vector<Transform> world_from_sensor;  ///< For each frame.
  double median_residual_m{};                ///< Root mean square of a frame's distances.
  double worst_residual_m{};
  std::size_t worst_frame{};
};

ThinnedCloud ThinnedFrame(const Frame& frame) {
  std::vector<Eigen::Vector3f> points_m;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (std::isfinite(frame.range_m[i])) points_m.emplace_back(frame.x[i], frame.y[i], frame.z[i]);
  }
  return ThinnedCloud(points_m);
}

/// @throws InputError if it cannot be laid, or does not fit.
LaidCloud LayFrame(const ThinnedCloud& before,
                   const ThinnedCloud& cloud,
                   const Transform& guess,
                   const std::string& name) {
  const std::size_t num_points = std::min(before.size(), cloud.size());
  if (num_points < kFewestLaid) {
    throw InputError(name + ": must have at least " + NumberText(kFewestLaid) +
                     " points in cells of 0.4 m to be laid on the frame before it" +
                     Got(num_points));
  }
  constexpr double kMostResidual_m = 1.0;
  const auto laid = LayOn(before, cloud, guess);
  if (!laid || !(laid->residual_m <= kMostResidual_m)) {
    throw InputError(name + ": must fit the frame before it to 1 m (got " +
                     (laid ? ShortText(laid->residual_m) + " m" : "no convergence") + ")");
  }
  return *laid;
}

/// Lays each cloud of a recording on the one before it: iterative closest points, from points to
/// planes (Chen and Medioni, 1992), with PCL. The motion within a scan is left out. The vehicle
/// begins at the world's origin.
/// @throws InputError "frame: rule (got value)" if a cloud cannot be laid on the one before it.
RegisteredPoses RegisterClouds(const std::filesystem::path& recording,
                               const Transform& vehicle_from_sensor) {
  const auto opened = OpenRecording(recording);
  RegisteredPoses registered;
  std::vector<double> residuals_m;
  std::optional<ThinnedCloud> before;
  Transform motion = Transform::Identity();  // From one frame to the next, as the last one was.
  while (const auto read = opened->Next()) {
    const RecordedFrame recorded = (*read)();
    const ThinnedCloud cloud = ThinnedFrame(recorded.frame);
    if (!before) {
      registered.world_from_sensor.push_back(vehicle_from_sensor);
      residuals_m.push_back(0.0);
    } else {
      const LaidCloud laid = LayFrame(*before, cloud, motion, recorded.name);
      motion = laid.onto_from_cloud;
      registered.world_from_sensor.push_back(registered.world_from_sensor.back() * motion);
      residuals_m.push_back(laid.residual_m);
    }
    before = cloud;
  }
  if (residuals_m.size() < 2) return registered;
  const auto worst = std::ranges::max_element(residuals_m);
  registered.worst_residual_m = *worst;
  registered.worst_frame = static_cast<std::size_t>(worst - residuals_m.begin());
  residuals_m.erase(residuals_m.begin());  // The first frame has nothing to be laid on.
  registered.median_residual_m = MedianOf(residuals_m);
  return registered;
}

/// What a frame says of its time and of its sensor's poses.
struct PosedFrame {
  std::string name;
  std::int64_t stamp_ns{};
  std::vector<ScanPose> poses{};  ///< world_from_sensor, by time; empty: not known.
  PointAxes axes = PointAxes::kSensorAtFiring;
  std::uint32_t last_instance{};  ///< The greatest number of its objects.
};

/// Masts and cantilevers of railcast's sequences have numbers of their own.
std::uint32_t InstanceOfObject(std::uint32_t instance) {
  return instance < kFirstMastInstance ? instance : 0;
}

PosedFrame PosedFrameOf(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  PosedFrame posed{.name = recorded.name, .stamp_ns = frame.stamp_ns, .axes = recorded.axes};
  if (recorded.Has("instance")) {
    for (const std::uint32_t instance : frame.instance) {
      posed.last_instance = std::max(posed.last_instance, instance);
    }
  }
  if (!recorded.has_pose) return posed;
  posed.poses.push_back({0, frame.world_from_sensor});
  posed.poses.insert(posed.poses.end(), frame.poses_between.begin(), frame.poses_between.end());
  posed.poses.push_back({frame.duration_ns, frame.world_from_sensor_end});
  return posed;
}

/// The frames of a directory that railcast wrote, of which only the lines are read.
std::vector<PosedFrame> ReadLinesOfSequence(const fs::path& directory) {
  const SequenceSummary summary = ReadSequenceSummary(directory);
  const bool is_kitti = summary.run.format == "kitti";
  FrameLineReader reader(summary);
  std::vector<PosedFrame> frames;
  while (const auto lines = reader.Next()) {
    const FrameRecord line = ReadNextFrameLine(*lines);
    CheckRecords(line, *lines);
    const PlacedLine& pose = lines->records.at(0);
    PosedFrame posed{.name = pose.place, .stamp_ns = line.stamp_ns};
    posed.poses.push_back({0, ReadPoseLine(pose.text, line.stamp_ns, pose.place)});
    const std::vector<ScanPose> scan_poses = ScanPosesOf(line.scan_poses);
    posed.poses.insert(posed.poses.end(), scan_poses.begin(), scan_poses.end());
    const PlacedLine& objects = lines->records.at(1);
    for (const RecordedObject& object : ReadObjectsLine(objects.text, line.frame, objects.place)) {
      posed.last_instance = std::max(posed.last_instance, InstanceOfObject(object.instance));
    }
    if (is_kitti) posed.axes = PointAxes::kSensorAtStamp;
    frames.push_back(std::move(posed));
  }
  return frames;
}

/// The frames of files that have neither stamps nor poses: what stands beside KITTI's clouds.
std::vector<PosedFrame> FramesOfFiles(const RecordingInfo& info) {
  std::vector<PosedFrame> frames(info.num_frames.value_or(0));
  const fs::path clouds = KittiSourceOf(info.source).clouds;
  const auto stamps_ns = StampsOfNames(CloudsOfDirectory(clouds).files);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].name = ShownPath(info.source) + ": frame " + NumberText(i);
    if (!stamps_ns.empty()) frames[i].stamp_ns = stamps_ns.at(i);
  }
  if (!info.has_kitti_labels) return frames;
  for (PosedFrame& frame : frames) frame.axes = PointAxes::kSensorAtStamp;
  const auto poses = ReadKittiPoses(clouds, frames.size());
  for (std::size_t i = 0; i < poses.world_from_sensor.size(); ++i) {
    frames[i].poses = {{0, poses.world_from_sensor[i]}};
  }
  for (std::size_t i = 0; i < poses.times_ns.size(); ++i) frames[i].stamp_ns = poses.times_ns[i];
  return frames;
}

std::vector<PosedFrame> ReadFrames(const fs::path& source) {
  const auto recording = OpenRecording(source);
  const RecordingInfo& info = recording->info();
  if (info.origin && info.kind != "merged clouds") return ReadLinesOfSequence(info.source);
  // Recordings into which something was put already have their poses beside them.
  const bool are_files = info.kind == "point cloud file" ||
                         info.kind == "directory of point clouds" || info.kind == "KITTI sequence";
  if (are_files && !info.scenario) return FramesOfFiles(info);
  std::vector<PosedFrame> frames;
  while (const auto read = recording->Next()) frames.push_back(PosedFrameOf((*read)()));
  return frames;
}

/// Gives frames the poses of a file, and its stamps to those that have none.
void UsePoseFile(const fs::path& file, const std::string& sensor, std::vector<PosedFrame>& frames) {
  const PoseFile poses = ReadPoseFile(file, sensor);
  if (poses.world_from_sensor.size() != frames.size()) {
    throw InputError(ShownPath(file) + ": must have a pose for each of the " +
                     NumberText(frames.size()) + " frames" + Got(poses.world_from_sensor.size()));
  }
  std::vector<FrameStamp> times;
  for (const PosedFrame& frame : frames) times.push_back({times.size(), frame.stamp_ns});
  CheckFrameStamps(poses, times, ShownPath(file));
  const bool has_stamps =
      std::ranges::any_of(frames, [](const PosedFrame& frame) { return frame.stamp_ns != 0; });
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].poses = {{0, poses.world_from_sensor[i]}};
    if (!has_stamps && !poses.stamps_ns.empty()) frames[i].stamp_ns = poses.stamps_ns[i];
  }
}

/// Says in a remark how long nothing was recorded.
void RemarkGaps(const std::vector<PosedFrame>& frames,
                const std::vector<std::int64_t>& times_ns,
                std::vector<std::string>& remarks) {
  std::vector<std::int64_t> steps_ns;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    steps_ns.push_back(times_ns[i] - times_ns[i - 1]);
  }
  if (steps_ns.size() < 2) return;
  std::vector<std::int64_t> sorted = steps_ns;
  constexpr std::int64_t kUsualSteps = 3;
  const std::int64_t most_ns = kUsualSteps * MedianOf(sorted);
  const auto num_gaps = std::ranges::count_if(steps_ns, [&](auto step) { return step > most_ns; });
  if (num_gaps == 0) return;
  const auto longest = std::ranges::max_element(steps_ns);
  const auto after = static_cast<std::size_t>(longest - steps_ns.begin()) + 1;
  remarks.push_back(NumberText(num_gaps) + (num_gaps == 1 ? " gap" : " gaps") +
                    " in the recording's times, the " + (num_gaps == 1 ? "one" : "longest") +
                    " of " + SecondsText(*longest) + " before " + frames[after].name +
                    ": the vehicle is taken to have moved evenly meanwhile");
}

void SetTimes(const std::vector<PosedFrame>& frames,
              const ScanSpec& scan,
              RecordedWay& way,
              std::vector<std::string>& remarks) {
  way.first_stamp_ns = frames.front().stamp_ns;
  const bool has_stamps = std::ranges::any_of(
      frames, [&](const PosedFrame& frame) { return frame.stamp_ns != way.first_stamp_ns; });
  if (!has_stamps && frames.size() > 1) {
    remarks.push_back("the frames have no stamps: they are taken to be 1/" +
                      NumberText(scan.rate_hz) + " s apart, as the sensor's rate_hz says");
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double assumed_ns = static_cast<double>(i) / scan.rate_hz * kNsPerS;
    way.frame_times_ns.push_back(has_stamps ? frames[i].stamp_ns - way.first_stamp_ns
                                            : std::llround(assumed_ns));
    if (i == 0) continue;
    const std::int64_t step_ns = way.frame_times_ns[i] - way.frame_times_ns[i - 1];
    if (step_ns > 0) continue;
    throw InputError(frames[i].name + ": stamp: must be after that of the frame before it (got " +
                     SecondsText(step_ns) + " after it)");
  }
  RemarkGaps(frames, way.frame_times_ns, remarks);
}

/// Checks that no railway vehicle is asked to jump.
void CheckStep(const VehiclePose& from, const VehiclePose& to, const std::string& name) {
  constexpr double kMostTurn_radps = 3.0;
  constexpr double kNoise_m = 1.0;
  constexpr double kNoise_rad = 0.1;
  const double step_s = SecondsFromNs(to.time_ns - from.time_ns);
  const Transform step = from.world_from_vehicle.inverse() * to.world_from_vehicle;
  const double length_m = step.translation().norm();
  const double turn_rad = std::abs(Eigen::AngleAxisd(step.linear()).angle());
  const std::string after = " in " + ShortText(step_s) + " s)";
  if (!(length_m <= kMostSpeed_mps * step_s + kNoise_m)) {
    throw InputError(name + ": pose: must not jump: at most 150 m/s from the one before it (got " +
                     ShortText(length_m) + " m" + after);
  }
  if (!(turn_rad <= kMostTurn_radps * step_s + kNoise_rad)) {
    throw InputError(name + ": pose: must not jump: at most 3 rad/s from the one before it (got " +
                     ShortText(DegFromRad(turn_rad)) + " deg" + after);
  }
}

/// Checks that the axes are those of a vehicle on rails, not those of a camera.
void CheckUpright(const Transform& world_from_vehicle, const std::string& name) {
  constexpr double kMostTilt_rad = RadFromDeg(45.0);
  const double tilt_rad = std::acos(std::clamp(world_from_vehicle.linear()(2, 2), -1.0, 1.0));
  if (tilt_rad <= kMostTilt_rad) return;
  throw InputError(name + ": pose: the vehicle's z axis must point up (got " +
                   ShortText(DegFromRad(tilt_rad)) +
                   " deg from it): its axes are x forward, y left, z up");
}

void CheckPosed(const std::vector<PosedFrame>& frames, const fs::path& source) {
  const auto first =
      std::ranges::find_if(frames, [](const PosedFrame& frame) { return frame.poses.empty(); });
  if (first == frames.end()) return;
  const bool has_any =
      std::ranges::any_of(frames, [](const PosedFrame& frame) { return !frame.poses.empty(); });
  throw InputError(
      (has_any ? first->name : ShownPath(source)) +
      ": pose: missing; /world/recording/poses of the plan must be \"standing\" or \"registered\"" +
      (has_any ? ", or --frames must leave this frame out" : ""));
}

void TakePoses(const std::vector<PosedFrame>& frames,
               const Transform& vehicle_from_sensor,
               RecordedWay& way) {
  const Transform sensor_from_vehicle = vehicle_from_sensor.inverse();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const ScanPose& pose : frames[i].poses) {
      const VehiclePose next{way.frame_times_ns[i] + pose.time_ns,
                             pose.world_from_sensor * sensor_from_vehicle};
      if (pose.time_ns == 0 && way.at_frames.size() == i) {
        CheckUpright(next.world_from_vehicle, frames[i].name);
        way.at_frames.push_back(next.world_from_vehicle);
      }
      if (way.is_held && pose.time_ns > 0) break;
      if (!way.poses.empty() && next.time_ns <= way.poses.back().time_ns) {
        // The last firing may be as late as the first one of the next frame, whose pose counts.
        if (pose.time_ns > 0) continue;
        while (!way.poses.empty() && way.poses.back().time_ns >= next.time_ns) way.poses.pop_back();
      }
      if (!way.poses.empty()) CheckStep(way.poses.back(), next, frames[i].name);
      way.poses.push_back(next);
    }
  }
  double length_m = 0.0;
  for (std::size_t i = 1; i < way.poses.size(); ++i) {
    length_m += (way.poses[i].world_from_vehicle.translation() -
                 way.poses[i - 1].world_from_vehicle.translation())
                    .norm();
  }
  if (way.poses.empty()) return;
  CheckSpeed(length_m, SecondsFromNs(way.poses.back().time_ns - way.poses.front().time_ns),
             frames.back().name);
}

void Register(const fs::path& source,
              const Transform& vehicle_from_sensor,
              std::vector<PosedFrame>& frames,
              std::vector<std::string>& remarks) {
  const RegisteredPoses registered = RegisterClouds(source, vehicle_from_sensor);
  Check(registered.world_from_sensor.size() == frames.size(), "a recording does not change");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].poses = {{0, registered.world_from_sensor[i]}};
  }
  remarks.push_back(
      "the poses are an estimate: each cloud was laid on the one before it, with a "
      "residual of " +
      ShortText(registered.median_residual_m) + " m in the median and " +
      ShortText(registered.worst_residual_m) + " m at worst, at " +
      frames[registered.worst_frame].name + "; errors add up along the way");
}

}  // namespace

Transform RecordedWay::WorldFromVehicle(std::int64_t time_ns) const {
  auto after = std::ranges::upper_bound(poses, time_ns, {}, &VehiclePose::time_ns);
  if (is_held || poses.size() == 1) {
    return (after == poses.begin() ? after : after - 1)->world_from_vehicle;
  }
  after = std::clamp(after, poses.begin() + 1, poses.end() - 1);
  const VehiclePose& from = *(after - 1);
  const VehiclePose& to = *after;
  const double share =
      static_cast<double>(time_ns - from.time_ns) / static_cast<double>(to.time_ns - from.time_ns);
  const Transform step = from.world_from_vehicle.inverse() * to.world_from_vehicle;
  const Eigen::AngleAxisd turn(step.linear());
  return from.world_from_vehicle *
         MakeTransform(Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix(),
                       share * step.translation());
}

RecordedWay ReadRecordedWay(const fs::path& recording,
                            const RecordingWorldSpec& world,
                            const LidarSpec& lidar,
                            std::vector<std::string>& remarks) {
  std::vector<PosedFrame> frames = ReadFrames(recording);
  if (frames.empty()) throw InputError(ShownPath(recording) + ": must have a frame (got none)");
  RecordedWay way;
  way.is_held = frames.front().axes == PointAxes::kSensorAtStamp;
  for (const PosedFrame& frame : frames) {
    way.last_instance = std::max(way.last_instance, frame.last_instance);
  }
  if (world.poses_file) UsePoseFile(*world.poses_file, lidar.name, frames);
  SetTimes(frames, lidar.scan, way, remarks);
  const PoseSource from = world.poses.value_or(PoseSource::kRecorded);
  const Transform vehicle_from_sensor = VehicleFromSensor(lidar.mount);
  if (from == PoseSource::kStanding) {
    for (PosedFrame& frame : frames) frame.poses = {{0, vehicle_from_sensor}};
    way.is_held = true;
  } else if (from == PoseSource::kRegistered) {
    Register(recording, vehicle_from_sensor, frames, remarks);
  }
  CheckPosed(frames, recording);
  TakePoses(frames, vehicle_from_sensor, way);
  return way;
}

}  // namespace railcast
