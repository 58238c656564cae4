#include "core/io/run/object_survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/io/record/record_text.h"
#include "core/io/run/frame_record.h"

namespace railcast {
namespace {

double ToTenthOfMillimetre(double length_m) {
  constexpr double kSteps_per_m = 1e4;
  // Adding zero makes -0 the same as 0.
  return std::round(length_m * kSteps_per_m) / kSteps_per_m + 0.0;
}

BoxRecord BoxOf(const Transform& to_from_box, const Vector3& size_m) {
  return {to_from_box.translation(), size_m, CanonicalRotation(to_from_box)};
}

ObjectRecord RecordOf(const ObjectInFrame& object, const Transform& sensor_from_world) {
  ObjectRecord record{.name = object.name,
                      .type = object.type,
                      .label = object.label,
                      .instance = object.instance,
                      .world = BoxOf(object.world_from_box, object.size_m),
                      .sensor = BoxOf(sensor_from_world * object.world_from_box, object.size_m),
                      .output = BoxOf(object.output_from_box, object.size_m),
                      .velocity_world_mps = object.velocity_world_mps,
                      .points = object.points,
                      .firings_visible = object.view.firings_visible,
                      .firings_alone = object.view.firings_alone,
                      .occlusion = object.view.occlusion(),
                      .contacts = object.contacts};
  if (object.points > 0) record.points_time_ns = object.points_time_ns;
  for (ContactRecord& contact : record.contacts) contact.gap_m = ToTenthOfMillimetre(contact.gap_m);
  return record;
}

struct Seen {
  std::uint32_t points{};
  std::uint64_t points_time_ns{};  // Sum over the points.
};

// Rounded; 0 without points.
std::uint32_t MeanTime_ns(const Seen& seen) {
  if (seen.points == 0) return 0;
  return static_cast<std::uint32_t>((seen.points_time_ns + seen.points / 2) / seen.points);
}

// The mirror image of an object is no point on it.
bool IsOnObject(const Frame& frame, std::size_t slot) {
  return frame.instance[slot] != 0 && frame.outcome[slot] != Outcome::kClutter &&
         HasPoint(frame.outcome[slot]);
}

// Points by instance.
std::unordered_map<std::uint32_t, Seen> CountPoints(const Frame& frame) {
  std::unordered_map<std::uint32_t, Seen> points;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!IsOnObject(frame, slot)) continue;
    Seen& seen = points[frame.instance[slot]];
    ++seen.points;
    seen.points_time_ns += frame.time_ns[slot];
  }
  return points;
}

// The contacts that each of so many objects has, in their order.
std::vector<std::vector<ObjectContact>> ContactsByObject(const std::vector<ObjectContact>& contacts,
                                                         std::size_t num_objects) {
  std::vector<std::vector<ObjectContact>> by_object(num_objects);
  for (const ObjectContact& contact : contacts) {
    by_object[contact.one].push_back(contact);
    by_object[contact.other].push_back(contact);
  }
  return by_object;
}

// Returns the smallest distance between the origin and the straight path from `begin` to `end`.
double NearestApproach_m(const Vector3& begin, const Vector3& end) {
  const Vector3 way = end - begin;
  const double length_squared = way.squaredNorm();
  if (length_squared == 0.0) return begin.norm();
  return (begin + std::clamp(-begin.dot(way) / length_squared, 0.0, 1.0) * way).norm();
}

// Returns the box as seen in left-handed axes, whose y points the other way: y is negated before
// and after, since a box is its own mirror image.
Transform Mirrored(const Transform& to_from_box) {
  const Eigen::DiagonalMatrix<double, 3> mirror(1.0, -1.0, 1.0);
  return MakeTransform(mirror * to_from_box.linear() * mirror, mirror * to_from_box.translation());
}

}  // namespace

ObjectsRecord RecordOf(const Frame& frame, const std::vector<ObjectInFrame>& objects) {
  const Transform sensor_from_world = frame.world_from_sensor.inverse();
  ObjectsRecord record{frame.index, frame.stamp_ns, {}};
  for (const ObjectInFrame& object : objects) {
    record.objects.push_back(RecordOf(object, sensor_from_world));
  }
  return record;
}

std::string ObjectsLine(const Frame& frame, const std::vector<ObjectInFrame>& objects) {
  return RecordText(RecordOf(frame, objects)) + "\n";
}

std::uint32_t PointsOnInstance(const Frame& frame, std::uint32_t instance) {
  std::uint32_t points = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    points += frame.instance[slot] == instance && IsOnObject(frame, slot) ? 1U : 0U;
  }
  return points;
}

ObjectSurvey::ObjectSurvey(const World& world,
                           const LabelTable& labels,
                           double range_max_m,
                           const OutputSpec& output)
    : world_(world), range_max_m_(range_max_m), output_(output), contacts_(world) {
  const std::vector<SceneObject>& objects = world.objects();
  std::unordered_map<const Model*, Eigen::AlignedBox3d> boxes;  // Many objects share a model.
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Label* label = labels.Find(objects[i].label);
    Check(label != nullptr, "an object's label is in the label table");
    const auto [box, is_new] = boxes.try_emplace(objects[i].model.get());
    if (is_new) box->second = objects[i].model->Bounds();
    const Eigen::AlignedBox3d& bounds_m = box->second;
    Subject subject{label->name, bounds_m.center(), bounds_m.sizes(), {}};
    if (!objects[i].moves) {
      subject.world_from_box = world.WorldFromObject(i, 0) * Eigen::Translation3d(subject.center_m);
    }
    subjects_.push_back(std::move(subject));
  }
}

ObjectSurvey::Course ObjectSurvey::CourseOf(std::size_t object, const Frame& frame) const {
  const Subject& subject = subjects_[object];
  if (subject.world_from_box) return {*subject.world_from_box, Vector3::Zero()};
  const auto world_from_box = [&](std::int64_t time_ns) -> Transform {
    return world_.WorldFromObject(object, time_ns) * Eigen::Translation3d(subject.center_m);
  };
  // Gives an instantaneous scan a velocity, too.
  constexpr std::uint32_t kMinSpan_ns = 1'000'000;
  const std::uint32_t span_ns = std::max(frame.duration_ns, kMinSpan_ns);
  const Transform begin = world_from_box(frame.stamp_ns);
  const Transform end = world_from_box(frame.stamp_ns + span_ns);
  return {begin, (end.translation() - begin.translation()) / SecondsFromNs(span_ns)};
}

bool ObjectSurvey::ComesWithinRange(std::size_t object,
                                    const Course& course,
                                    const Frame& frame) const {
  const Vector3 begin = course.world_from_box.translation() - frame.world_from_sensor.translation();
  const Vector3 end = course.world_from_box.translation() +
                      course.velocity_mps * SecondsFromNs(frame.duration_ns) -
                      frame.world_from_sensor_end.translation();
  return NearestApproach_m(begin, end) <= range_max_m_ + subjects_[object].size_m.norm() / 2.0;
}

Transform ObjectSurvey::OutputFromWorld(const Frame& frame) const {
  if (output_.frame == OutputFrame::kWorld) {
    return Transform(Eigen::Translation3d(
        -Vector3(output_.origin_m[0], output_.origin_m[1], output_.origin_m[2])));
  }
  return output_.frame == OutputFrame::kVehicle ? world_.WorldFromVehicle(frame.stamp_ns).inverse()
                                                : frame.world_from_sensor.inverse();
}

std::vector<ObjectInFrame> ObjectSurvey::Describe(const Frame& frame,
                                                  const std::vector<ObjectView>& views) {
  const std::vector<SceneObject>& all = world_.objects();
  Check(views.size() == all.size(), "one view for each object");
  const auto points = CountPoints(frame);
  const Transform output_from_world = OutputFromWorld(frame);
  const auto contacts = ContactsByObject(contacts_.FindAll(frame.stamp_ns), all.size());
  std::vector<ObjectInFrame> described;
  described.reserve(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const SceneObject& object = all[i];
    if (object.is_ego) continue;
    const Course course = CourseOf(i, frame);
    if (!ComesWithinRange(i, course, frame)) continue;
    ObjectInFrame entry{object.name, object.type, subjects_[i].label, object.instance};
    entry.size_m = subjects_[i].size_m;
    entry.world_from_box = course.world_from_box;
    entry.velocity_world_mps = course.velocity_mps;
    entry.output_from_box = output_from_world * course.world_from_box;
    if (output_.handedness == Handedness::kLeft)
      entry.output_from_box = Mirrored(entry.output_from_box);
    entry.view = views[i];
    if (const auto found = points.find(object.instance); found != points.end()) {
      entry.points = found->second.points;
      entry.points_time_ns = MeanTime_ns(found->second);
    }
    for (const ObjectContact& contact : contacts[i]) {
      const std::size_t other = contact.one == i ? contact.other : contact.one;
      entry.contacts.push_back({all[other].name, contact.is_overlap(), contact.gap_m});
    }
    described.push_back(std::move(entry));
  }
  return described;
}

ObjectSurvey& CurrentSurvey::Of(const Simulator& simulator, const LabelTable& labels) {
  if (world_ != simulator.shared_world()) {
    survey_.reset();
    world_ = simulator.shared_world();
    survey_.emplace(*world_, labels, simulator.spec().detector.range_max_m,
                    simulator.spec().output);
  }
  return *survey_;
}

}  // namespace railcast
