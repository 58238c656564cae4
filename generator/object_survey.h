#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/frame/frame.h"
#include "core/frame/labels.h"
#include "core/frame/output_spec.h"
#include "core/scene/world.h"
#include "generator/object_record.h"

namespace railcast {

/// Finds out what frames show of a world's objects.
class ObjectSurvey {
 public:
  /// @param world Must outlive the survey.
  /// @param range_max_m Of the sensor.
  /// @param output The axes of the frames' points.
  ObjectSurvey(const World& world,
               const LabelTable& labels,
               double range_max_m,
               const OutputSpec& output);

  /// The objects whose bounding sphere comes within range_max_m of the sensor during the scan,
  /// in the world's order; never the sensor's own vehicle.
  /// @param firings_alone Of each of world.objects(), as Simulator::FiringsOnObjectAlone gives
  ///   them.
  [[nodiscard]] std::vector<ObjectInFrame> Describe(
      const Frame& frame, const std::vector<std::uint32_t>& firings_alone) const;

 private:
  /// What does not change from frame to frame.
  struct Subject {
    std::string label;
    Vector3 center_m;  ///< Of its box, in its own axes.
    Vector3 size_m;
    std::optional<Transform> world_from_box;  ///< Of what stands.
  };
  /// An object's way during a scan.
  struct Course {
    Transform world_from_box;  ///< At the stamp.
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
};

}  // namespace railcast
