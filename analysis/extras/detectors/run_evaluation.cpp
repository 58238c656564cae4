#include "analysis/extras/detectors/run_evaluation.h"

#include <algorithm>
#include <utility>

#include "core/io/recording/recorded_motion.h"

namespace railcast {
namespace {

bool IsEverInWay(const ObjectCourse& course) {
  return std::ranges::any_of(course.sightings, &Sighting::is_in_way);
}

// The rule for what a detector reports: seen or not.
DetectionRule RuleOfFrames(DetectionRule rule) {
  rule.min_points = 1;
  return rule;
}

}  // namespace

std::vector<std::string> EvaluatedRun::ObjectsBeside() const {
  std::vector<std::string> names;
  for (const auto& [name, course] : run.courses.objects) {
    const bool is_approached =
        !course.sightings.empty() && IsApproached(ApproachIn(course.sightings));
    if (is_approached && !IsEverInWay(course)) names.push_back(name);
  }
  return names;
}

RunEvaluator::RunEvaluator(const OwnTrack& track,
                           const LabelTable& labels,
                           const Transform& vehicle_from_sensor)
    : track_(track), labels_(labels), vehicle_from_sensor_(vehicle_from_sensor) {}

void RunEvaluator::Add(const RecordedFrame& recorded, const FrameDetections& detections) {
  const Frame& frame = recorded.frame;
  AddFrame(recorded, vehicle_from_sensor_, track_, courses_);
  const Transform world_from_vehicle = frame.world_from_sensor * vehicle_from_sensor_.inverse();
  // Detected boxes are where things were at the stamp as their points show them.
  const RecordedMotion motion(recorded, Compensation::kSensor);
  std::vector<OrientedBox> true_boxes;
  for (const RecordedObject& object : recorded.objects) {
    true_boxes.push_back(
        Grown({frame.world_from_sensor * motion.BoxOf(object), object.size_m}, kBoxSlack_m));
    courses_.objects.at(object.name).sightings.back().points = 0;
  }
  std::vector<GaugeBox>& boxes = boxes_.emplace_back();
  counts_.read += detections.boxes.size();
  for (const DetectedBox& detected : detections.boxes) {
    const OrientedBox& box = detected.box;
    if (!track_.ClearanceAhead(world_from_vehicle, box.world_from_box, box.size_m).is_inside) {
      continue;
    }
    const Label* const label = detected.label == 0 ? nullptr : labels_.Find(detected.label);
    GaugeBox found{
        .s_m = track_.ChainageNear_m(box.world_from_box.translation()),
        .distance_m = DistanceToBox(
            box.world_from_box.inverse() * frame.world_from_sensor.translation(), box.size_m),
        .cause = label == nullptr ? detected.class_name : label->name,
        .objects = {}};
    for (std::size_t i = 0; i < true_boxes.size(); ++i) {
      if (OverlapOf(box, true_boxes[i]) < kLeastOverlap) continue;
      found.objects.push_back(recorded.objects[i].name);
      courses_.objects.at(recorded.objects[i].name).sightings.back().points = 1;
    }
    ++counts_.in_gauge;
    counts_.matched += found.objects.empty() ? 0U : 1U;
    boxes.push_back(std::move(found));
  }
  frames_.push_back(frame.index);
  latencies_s_.push_back(detections.latency_s);
  sensor_m_.emplace_back(frame.world_from_sensor.translation());
}

std::vector<FalseAlarm> RunEvaluator::AlarmsAt(const std::string& object,
                                               const DetectionRule& rule) const {
  // A box that is also of an object in the way is a reason to brake.
  const auto is_of = [&](const GaugeBox& box) {
    if (object.empty()) return box.objects.empty();
    return std::ranges::find(box.objects, object) != box.objects.end() &&
           std::ranges::none_of(box.objects, [&](const std::string& name) {
             return IsEverInWay(courses_.objects.at(name));
           });
  };
  std::vector<FalseAlarm> alarms;
  std::vector<Sighting> sightings;
  bool was_alarm = false;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const GaugeBox* nearest = nullptr;
    for (const GaugeBox& box : boxes_[i]) {
      if (!is_of(box)) continue;
      if (nearest == nullptr || box.distance_m < nearest->distance_m) nearest = &box;
    }
    sightings.push_back(
        {.frame = static_cast<std::uint32_t>(i), .points = nearest == nullptr ? 0U : 1U});
    const bool is_alarm = CompletesRule(sightings, rule);
    // A rule comes to hold in a frame that has a box.
    if (is_alarm && !was_alarm) {
      alarms.push_back({.frame = frames_[i],
                        .s_m = nearest->s_m,
                        .distance_m = nearest->distance_m,
                        .object = object,
                        .cause = nearest->cause});
    }
    was_alarm = is_alarm;
  }
  return alarms;
}

EvaluatedRun RunEvaluator::Finish(std::filesystem::path source,
                                  std::uint64_t seed,
                                  DetectSpec spec) {
  spec.rule = RuleOfFrames(spec.rule);
  EvaluatedRun result;
  for (std::size_t i = 1; i < sensor_m_.size(); ++i) {
    result.driven_m += (sensor_m_[i] - sensor_m_[i - 1]).norm();
  }
  std::vector<std::string> causes = {""};
  for (const auto& [name, course] : courses_.objects) {
    if (!IsEverInWay(course)) causes.push_back(name);
  }
  for (const std::string& object : causes) {
    for (FalseAlarm& alarm : AlarmsAt(object, spec.rule)) result.alarms.push_back(std::move(alarm));
  }
  std::ranges::stable_sort(result.alarms, {}, &FalseAlarm::frame);
  result.run = DetectInRun(std::move(source), seed, std::move(courses_), spec);
  for (auto& [name, detection] : result.run.detections) {
    if (!detection.frame) continue;
    AddLatency(result.run.courses.objects.at(name), latencies_s_[*detection.frame], detection);
  }
  result.boxes = counts_;
  result.frames = std::move(frames_);
  result.latencies_s = std::move(latencies_s_);
  return result;
}

void AddLatency(const ObjectCourse& course, double latency_s, ObjectDetection& detection) {
  if (!detection.frame) return;
  const auto sighting = std::ranges::find(course.sightings, *detection.frame, &Sighting::frame);
  const double closing_mps = detection.speed_mps + std::max(0.0, sighting->approach_mps);
  detection.distance_m = std::max(0.0, detection.distance_m - latency_s * closing_mps);
}

}  // namespace railcast
