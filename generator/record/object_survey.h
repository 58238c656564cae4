#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/object_contacts.h"
#include "generator/record/object_record.h"
#include "railcast/frame.h"
#include "railcast/scene.h"
#include "railcast/simulator.h"

namespace railcast {

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
