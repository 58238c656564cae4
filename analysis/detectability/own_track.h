#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/base/transform.h"
#include "core/rail/line/alignment.h"
#include "core/rail/structure_gauge.h"
#include "core/scenario/scenario_spec.h"

namespace railcast {

/// The track that the vehicle is on: what lies ahead in its structure gauge is in the way.
class OwnTrack {
 public:
  /// @throws InputError as MakeWorld() does.
  explicit OwnTrack(const ScenarioSpec& scenario);

  /// How a box stands to the gauge of the track ahead, where it comes nearest to it. What is behind
  /// the vehicle, or beyond the track's ends, is not inside, and infinitely far from the axis.
  [[nodiscard]] GaugeClearance ClearanceAhead(const Transform& world_from_vehicle,
                                              const Transform& world_from_box,
                                              const Vector3& size_m) const;

 private:
  /// Of the axis' point that is nearest to this one.
  [[nodiscard]] double ChainageNear_m(const Vector3& world_m) const;
  /// The same from a chainage near it on.
  [[nodiscard]] double Refined_m(double s_m, const Vector3& world_m) const;

  Alignment alignment_;
  double offset_m_{};
  double start_s_m_{};
  double end_s_m_{};
  std::vector<GaugePart> gauge_;
  std::vector<Vector3> axis_m_;  ///< Every kAxisStep_m of chainage from the track's start.
};

}  // namespace railcast
