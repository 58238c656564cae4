#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run/object_record.h"
#include "core/scene/object_contacts.h"
#include "railcast/frame.h"
#include "railcast/scene.h"
#include "railcast/simulator.h"
#include "railcast/transform.h"

namespace railcast {

/// One object as seen in one frame.
struct ObjectInFrame {
  std::string name;
  std::string type;
  std::string label;
  std::uint32_t instance{};
  Vector3 size_m = Vector3::Zero();                  ///< Size of its oriented box.
  Transform world_from_box = Transform::Identity();  ///< Centre and axes of its box at the stamp.
  /// Centre and axes of its box relative to the axes of the frame's points. Where those are
  /// left-handed it is the pose of the mirrored box, which is again a proper rotation.
  Transform output_from_box = Transform::Identity();
  /// Velocity of the box's centre, mean over the scan.
  Vector3 velocity_world_mps = Vector3::Zero();
  std::uint32_t points{};          ///< Slots with a point on the object.
  std::uint32_t points_time_ns{};  ///< Mean time of those points since the stamp.
  ObjectView view{};
  std::vector<ContactRecord> contacts{};  ///< At the stamp, in the world's order.
};

/// What objects.jsonl says of a frame's objects.
[[nodiscard]] ObjectsRecord RecordOf(const Frame& frame, const std::vector<ObjectInFrame>& objects);

/// The frame's line of objects.jsonl, with its end.
[[nodiscard]] std::string ObjectsLine(const Frame& frame,
                                      const std::vector<ObjectInFrame>& objects);

/// Number of slots with a point on one object.
[[nodiscard]] std::uint32_t PointsOnInstance(const Frame& frame, std::uint32_t instance);

/// Determines what frames show of a world's objects.
class ObjectSurvey {
 public:
  /// @param world Must outlive the survey.
  /// @param range_max_m Maximum range of the sensor.
  /// @param output Axes of the frames' points.
  ObjectSurvey(const World& world,
               const LabelTable& labels,
               double range_max_m,
               const OutputSpec& output);

  /// Returns the objects whose bounding sphere comes within range_max_m of the sensor during the
  /// scan, in the world's order, without the sensor's own vehicle.
  /// @param views One for each of world.objects(), from Simulator::ViewObjects().
  [[nodiscard]] std::vector<ObjectInFrame> Describe(const Frame& frame,
                                                    const std::vector<ObjectView>& views);

 private:
  /// What does not change from frame to frame.
  struct Subject {
    std::string label;
    Vector3 center_m;  ///< Centre of its box in its own axes.
    Vector3 size_m;
    std::optional<Transform> world_from_box;  ///< Set for objects that do not move.
  };
  /// An object's motion during a scan.
  struct Course {
    Transform world_from_box;  ///< Pose at the stamp.
    Vector3 velocity_mps;
  };
  [[nodiscard]] Course CourseOf(std::size_t object, const Frame& frame) const;
  [[nodiscard]] bool ComesWithinRange(std::size_t object,
                                      const Course& course,
                                      const Frame& frame) const;
  [[nodiscard]] Transform OutputFromWorld(const Frame& frame) const;

  const World& world_;
  double range_max_m_;
  OutputSpec output_;
  std::vector<Subject> subjects_;  ///< In the order of world.objects().
  ContactFinder contacts_;
};

/// The survey of a simulator's world. Commands give a simulator another world.
class CurrentSurvey {
 public:
  /// @param labels Must outlive the survey.
  [[nodiscard]] ObjectSurvey& Of(const Simulator& simulator, const LabelTable& labels);

 private:
  std::shared_ptr<const World> world_;
  std::optional<ObjectSurvey> survey_;
};

}  // namespace railcast
