#include "analysis/extras/detectors/reported_detections.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/scan_motion.h"
#include "core/io/write_file.h"
#include "core/scenario/json_reader.h"
#include "core/scenario/json_source.h"
#include "core/scenario/json_text.h"

namespace railcast {

void Describe(Archive& a, ReportedDetection& s) {
  a.Optional("center_m", s.center_m, "Centre of a box.", Within(-kFarthestBox_m, kFarthestBox_m));
  a.Optional("size_m", s.size_m, "Length, width and height of a box.", PositiveUpTo(kLargestBox_m));
  a.Optional("quaternion_xyzw", s.quaternion_xyzw, "Turns the box.", Within(-1, 1));
  a.Optional("points", s.points, "Points of a cluster, by their places in the frame's file.",
             NonEmptyList());
  a.Optional("score", s.score, "How sure the detector is.", Within(0, 1));
  a.Optional("class", s.class_name, "What it is taken for.", OneLine());
  const Eigen::Map<const Eigen::Vector4d> turn(s.quaternion_xyzw.data());
  constexpr double kRounding = 1e-3;
  a.Ensure({"quaternion_xyzw"}, std::abs(turn.norm() - 1.0) <= kRounding, "must have length 1");
  a.Ensure({"", "center_m", "size_m", "points"},
           s.points ? !s.center_m && !s.size_m : s.center_m && s.size_m,
           "must have either center_m and size_m, or points");
}

void Describe(Archive& a, ReportedFrame& s) {
  a.Required("frame", s.frame, "Number of the frame, as its file has it.");
  a.Optional("latency_ms", s.latency_ms, "From the stamp until this is known.", Within(0, 1e5));
  a.Optional("compensate", s.compensation, "Which motion had been undone.");
  a.Optional("axes", s.axes, "Whose axes the boxes are in.");
  a.Optional("handedness", s.handedness, "Handedness of these axes.");
  a.Required("detections", s.detections, "Detections of this frame; may be empty.");
}

namespace {

// A line without its end. The place, "FILE:3", is for messages.
ReportedFrame ReadDetectionLine(std::string_view line, const std::string& place) {
  JsonSource source;
  ReportedFrame frame;
  frame.place = place;
  if (const auto root = source.OpenText(std::string(line), place)) {
    if (auto list = source.PlainMembers(*root)) {
      ReadMembers(source, *root, std::move(*list), frame);
    }
  }
  source.errors().ThrowIfAny();
  return frame;
}

// In the axes in which it is reported.
OrientedBox BoxAsReported(const ReportedDetection& detection) {
  const auto& [x, y, z] = *detection.center_m;
  const auto& [qx, qy, qz, qw] = detection.quaternion_xyzw;
  const auto& [length_m, width_m, height_m] = *detection.size_m;
  return {
      MakeTransform(Eigen::Quaterniond(qw, qx, qy, qz).normalized().toRotationMatrix(), {x, y, z}),
      {length_m, width_m, height_m}};
}

// Whose axes the boxes of a line are in. They are not guessed: a detector may have the points of
// the run's files, or those of Python, which are always in the sensor's axes.
OutputSpec AxesOfBoxes(const ReportedFrame& reported, const OutputSpec& of_points) {
  OutputSpec axes = of_points;
  axes.frame = reported.axes.value_or(OutputFrame::kSensor);
  axes.handedness = reported.handedness.value_or(Handedness::kRight);
  if (std::ranges::none_of(reported.detections,
                           [](const auto& detection) { return detection.center_m.has_value(); })) {
    return axes;
  }
  const auto fail = [&](const std::string& key, const std::string& choices, std::string_view of) {
    throw InputError(
        {{reported.place + ": /" + key,
          "missing, must be " + choices +
              ", as the boxes are: the points of the run's files are \"" + std::string(of) + "\"",
          ""}});
  };
  if (!reported.axes && of_points.frame != OutputFrame::kSensor) {
    fail("axes", R"("sensor", "vehicle" or "world")", NameOf(of_points.frame));
  }
  if (!reported.handedness && of_points.handedness != Handedness::kRight) {
    fail("handedness", R"("right" or "left")", NameOf(of_points.handedness));
  }
  return axes;
}

// The box in the sensor's axes, of which the points are. The frame's pose is that at the stamp.
OrientedBox InSensorAxes(OrientedBox box,
                         const OutputSpec& axes,
                         const Transform& vehicle_from_sensor,
                         const Frame& frame) {
  Transform& from_box = box.world_from_box;
  if (axes.handedness == Handedness::kLeft) {
    // As ObjectInFrame::output_from_box: the pose of the mirrored box.
    const Eigen::DiagonalMatrix<double, 3> mirror(1.0, -1.0, 1.0);
    from_box = MakeTransform(mirror * from_box.linear() * mirror, mirror * from_box.translation());
  }
  if (axes.frame == OutputFrame::kVehicle) {
    from_box = vehicle_from_sensor.inverse() * from_box;
  } else if (axes.frame == OutputFrame::kWorld) {
    const auto& [x, y, z] = axes.origin_m;
    from_box = frame.world_from_sensor.inverse() * (Eigen::Translation3d(x, y, z) * from_box);
  }
  return box;
}

/// The points in a box, in the axes that the motion leaves them in.
struct PointsInBox {
  std::vector<std::uint32_t> labels;
  std::uint64_t sum_ns{};

  [[nodiscard]] std::uint32_t mean_ns() const {
    return labels.empty() ? 0 : static_cast<std::uint32_t>(sum_ns / labels.size());
  }
};

PointsInBox PointsOfBox(const OrientedBox& box,
                        const RecordedFrame& recorded,
                        const RecordedMotion& motion) {
  constexpr double kNoise_m = 0.1;
  const OrientedBox grown = Grown(box, kNoise_m);
  const Frame& frame = recorded.frame;
  PointsInBox points;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isfinite(frame.x[slot])) continue;
    if (!IsInside(grown, motion.PointOf(slot).cast<double>())) continue;
    points.labels.push_back(frame.label[slot]);
    points.sum_ns += frame.time_ns[slot];
  }
  return points;
}

class Placing {
 public:
  Placing(const ReportedFrame& reported,
          const RecordedFrame& recorded,
          const PointsOfRun& run,
          const OwnTrack& track)
      : reported_(reported),
        recorded_(recorded),
        vehicle_from_sensor_(run.vehicle_from_sensor),
        axes_(AxesOfBoxes(reported, run.output)),
        track_(track),
        // Points of the world's axes have no motion left.
        compensation_(axes_.frame == OutputFrame::kWorld ? Compensation::kSensor
                                                         : reported.compensation),
        motion_(recorded, compensation_),
        undone_(recorded, Compensation::kSensor) {}

  [[nodiscard]] DetectedBox BoxOf(const ReportedDetection& detection) const {
    OrientedBox box =
        InSensorAxes(BoxAsReported(detection), axes_, vehicle_from_sensor_, recorded_.frame);
    const PointsInBox points = PointsOfBox(box, recorded_, motion_);
    if (compensation_ == Compensation::kNone && KnowsMotion(recorded_)) {
      box.world_from_box.translation() =
          ScanMotion(recorded_.frame).AtStamp(box.world_from_box.translation(), points.mean_ns());
    }
    box.world_from_box = recorded_.frame.world_from_sensor * box.world_from_box;
    return {box, MostFrequentLabel(points.labels), detection.class_name};
  }

  [[nodiscard]] DetectedBox ClusterOf(const ReportedDetection& detection, std::size_t index) const {
    std::vector<PlaceByTrack> places;
    std::vector<std::uint32_t> labels;
    for (std::size_t i = 0; i < detection.points->size(); ++i) {
      const std::uint32_t slot = SlotOf((*detection.points)[i], index, i);
      const Vector3 world_m =
          recorded_.frame.world_from_sensor * undone_.PointOf(slot).cast<double>();
      places.push_back(PlaceOnTrack(track_, world_m));
      labels.push_back(recorded_.frame.label[slot]);
    }
    return {BoxOfCluster(track_, places), MostFrequentLabel(labels), detection.class_name};
  }

 private:
  [[nodiscard]] std::uint32_t SlotOf(std::uint32_t point, std::size_t index, std::size_t i) const {
    const std::vector<std::uint32_t>& slots = recorded_.slot_of_entry;
    const auto fail = [&](const std::string& rule) {
      throw InputError(
          {{reported_.place + ": /detections/" + NumberText(index) + "/points/" + NumberText(i),
            rule, NumberText(point)}});
    };
    if (point >= slots.size()) {
      fail("must be < " + NumberText(slots.size()) + ", the number of points of " + recorded_.name);
    }
    const std::uint32_t slot = slots[point];
    if (slot == kNoSlot || !std::isfinite(recorded_.frame.x[slot])) {
      fail("must be a point, not a firing without one");
    }
    return slot;
  }

  const ReportedFrame& reported_;
  const RecordedFrame& recorded_;
  const Transform& vehicle_from_sensor_;
  OutputSpec axes_;  ///< The axes of the boxes.
  const OwnTrack& track_;
  Compensation compensation_;
  RecordedMotion motion_;  ///< As the detector has it.
  RecordedMotion undone_;
};

}  // namespace

ReportedRun ReadDetectionLines(const std::string& text, const std::string& shown) {
  ReportedRun run;
  std::string_view rest = text;
  std::size_t number = 0;
  while (const auto line = TakeLine(rest)) {
    ReportedFrame frame = ReadDetectionLine(*line, shown + ":" + NumberText(++number));
    if (!run.empty() && frame.frame <= run.back().frame) {
      throw InputError({{frame.place + ": /frame",
                         "must be > that of the line before, " + NumberText(run.back().frame),
                         NumberText(frame.frame)}});
    }
    run.push_back(std::move(frame));
  }
  return run;
}

ReportedRun ReadReportedRun(const std::filesystem::path& file,
                            const Transform& vehicle_from_sensor) {
  const std::string text = ReadFileWhole(file);
  const Json whole = Json::parse(text, nullptr, false);
  return whole.is_object() && whole.contains("openlabel")
             ? ReadOpenLabelRun(text, ShownPath(file), vehicle_from_sensor)
             : ReadDetectionLines(text, ShownPath(file));
}

const ReportedFrame* ReportedFrames::Of(std::uint32_t frame) {
  if (next_ == run_.size() || run_[next_].frame > frame) return nullptr;
  if (run_[next_].frame < frame) FailAt(run_[next_]);
  return &run_[next_++];
}

void ReportedFrames::CheckEnd() const {
  if (next_ < run_.size()) FailAt(run_[next_]);
}

void ReportedFrames::FailAt(const ReportedFrame& reported) const {
  throw InputError(
      {{reported.place + ": /frame", "must be a frame of the run", NumberText(reported.frame)}});
}

std::vector<DetectedBox> DetectionsOf(const ReportedFrame& reported,
                                      const RecordedFrame& recorded,
                                      const PointsOfRun& run,
                                      const OwnTrack& track,
                                      double min_score) {
  const Placing placing(reported, recorded, run, track);
  std::vector<DetectedBox> boxes;
  for (std::size_t i = 0; i < reported.detections.size(); ++i) {
    const ReportedDetection& detection = reported.detections[i];
    if (detection.score < min_score) continue;
    boxes.push_back(detection.points ? placing.ClusterOf(detection, i) : placing.BoxOf(detection));
  }
  return boxes;
}

}  // namespace railcast
