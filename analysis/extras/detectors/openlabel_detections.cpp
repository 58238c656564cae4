#include <algorithm>
#include <set>
#include <utility>

#include "analysis/extras/detectors/reported_detections.h"
#include "core/base/text.h"
#include "core/io/openlabel.h"

namespace railcast {
namespace {

constexpr std::size_t kNumbersOfCuboid = 10;

// The way up from a coordinate system to the one without a parent.
Transform TopFromSystem(const Json& systems, const std::string& name, const OpenLabelPlace& place) {
  Transform top_from_system = Transform::Identity();
  std::set<std::string> passed;
  std::string here = name;
  while (true) {
    const OpenLabelPlace own = place / here;
    if (!passed.insert(here).second) own.Fail("must not be above itself");
    const Json& system = OpenLabelMember(systems, here, place);
    const std::string parent = OpenLabelText(system, "parent", own);
    if (parent.empty()) return top_from_system;
    top_from_system = OpenLabelTransform(OpenLabelMember(system, "pose_wrt_parent", own),
                                         own / "pose_wrt_parent") *
                      top_from_system;
    here = parent;
  }
}

class Cuboids {
 public:
  Cuboids(const Json& openlabel, OpenLabelPlace place, const Transform& vehicle_from_sensor)
      : openlabel_(openlabel),
        place_(std::move(place)),
        sensor_from_top_(vehicle_from_sensor.inverse()) {}

  [[nodiscard]] std::vector<ReportedDetection> InFrame(const Json& frame,
                                                       const OpenLabelPlace& place) {
    std::vector<ReportedDetection> detections;
    if (!frame.is_object()) place.Fail("must be an object");
    if (!frame.contains("objects")) return detections;
    const Json& objects = frame.at("objects");
    if (!objects.is_object()) (place / "objects").Fail("must be an object");
    for (const auto& [uid, object] : objects.items()) {
      const OpenLabelPlace own = place / "objects" / uid / "object_data";
      const Json& data = OpenLabelMember(object, "object_data", place / "objects" / uid);
      if (!data.is_object()) own.Fail("must be an object");
      if (!data.contains("cuboid")) continue;
      const Json& cuboids = data.at("cuboid");
      if (!cuboids.is_array()) (own / "cuboid").Fail("must be a list");
      for (std::size_t i = 0; i < cuboids.size(); ++i) {
        detections.push_back(DetectionOf(cuboids[i], own / "cuboid" / NumberText(i)));
        detections.back().class_name = ClassOf(uid);
      }
    }
    return detections;
  }

 private:
  [[nodiscard]] ReportedDetection DetectionOf(const Json& cuboid, const OpenLabelPlace& place) {
    const std::vector<double> numbers =
        OpenLabelNumbers(OpenLabelMember(cuboid, "val", place), kNumbersOfCuboid, place / "val");
    const Eigen::Map<const Eigen::Array3d> middle_m(numbers.data());
    const Eigen::Map<const Eigen::Array3d> size_m(numbers.data() + 7);
    if ((middle_m.abs() > kFarthestBox_m).any()) (place / "val").Fail("must be within 10000 km");
    if ((size_m <= 0.0).any() || (size_m > kLargestBox_m).any()) {
      (place / "val").Fail("must end in three sizes > 0 and <= 1000");
    }
    const Transform box = SensorFrom(OpenLabelText(cuboid, "coordinate_system", place)) *
                          OpenLabelPose(numbers, place / "val");
    const Eigen::Quaterniond turn(box.linear());
    const Vector3& center_m = box.translation();
    ReportedDetection detection;
    detection.center_m = {center_m.x(), center_m.y(), center_m.z()};
    detection.size_m = {size_m.x(), size_m.y(), size_m.z()};
    detection.quaternion_xyzw = {turn.x(), turn.y(), turn.z(), turn.w()};
    return detection;
  }

  [[nodiscard]] const Transform& SensorFrom(const std::string& system) {
    const auto [entry, is_new] = sensor_from_.try_emplace(system);
    if (is_new) {
      entry->second = sensor_from_top_ *
                      TopFromSystem(OpenLabelMember(openlabel_, "coordinate_systems", place_),
                                    system, place_ / "coordinate_systems");
    }
    return entry->second;
  }

  [[nodiscard]] std::string ClassOf(const std::string& uid) const {
    const OpenLabelPlace place = place_ / "objects";
    return OpenLabelText(
        OpenLabelMember(OpenLabelMember(openlabel_, "objects", place_), uid, place), "type",
        place / uid);
  }

  const Json& openlabel_;
  OpenLabelPlace place_;
  Transform sensor_from_top_;
  std::map<std::string, Transform> sensor_from_;  ///< By coordinate system.
};

}  // namespace

ReportedRun ReadOpenLabelRun(const std::string& text,
                             const std::string& shown,
                             const Transform& vehicle_from_sensor) {
  const Json json = ParseOpenLabel(text, shown);
  const OpenLabelPlace place = OpenLabelPlace{shown, ""} / "openlabel";
  const Json& openlabel = OpenLabelMember(json, "openlabel", {shown, ""});
  const OpenLabelPlace frames_place = place / "frames";
  const Json& frames = OpenLabelMember(openlabel, "frames", place);
  if (!frames.is_object()) frames_place.Fail("must be an object");
  Cuboids cuboids(openlabel, place, vehicle_from_sensor);
  ReportedRun run;
  for (const auto& [key, frame] : frames.items()) {
    const auto number = ParseNumber<std::uint32_t>(key);
    if (!number) (frames_place / key).Fail("must be named by its number");
    run.push_back({.frame = *number,
                   .latency_ms = {},
                   .compensation = Compensation::kSensor,
                   .detections = cuboids.InFrame(frame, frames_place / key),
                   .place = shown + ": " + (frames_place / key).pointer,
                   .axes = OutputFrame::kSensor,
                   .handedness = Handedness::kRight});
  }
  // Their numbers are texts, and those stand in any order.
  std::ranges::sort(run, {}, &ReportedFrame::frame);
  const auto twice = std::ranges::adjacent_find(run, {}, &ReportedFrame::frame);
  if (twice != run.end()) {
    (frames_place / NumberText(twice->frame)).Fail("must be named once");
  }
  return run;
}

}  // namespace railcast
