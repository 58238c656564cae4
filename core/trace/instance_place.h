// See core/detect/base/vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_TRACE_INSTANCE_PLACE_H_
#define RAILCAST_TRACE_INSTANCE_PLACE_H_

#include <cmath>
#include <cstddef>

#include "core/trace/beam_cone.h"
#include "core/trace/beam_tree.h"

#ifndef RAILCAST_ISA
#define RAILCAST_ISA baseline
#endif

/// Where instances are at the time of a beam.
namespace railcast::RAILCAST_ISA {

/// The transforms between the window and an instance's model at one time.
struct InstancePlace {
  Rows window_from_model;
  Rows model_from_window;
};

/// A time between two steps of a moving instance.
struct BetweenSteps {
  std::size_t before;
  float part;  ///< Part of the way to the next step.
};

[[nodiscard]] inline BetweenSteps StepsAt(const BeamInstance& instance, float shutter) {
  const float last = static_cast<float>(instance.num_steps - 1);
  const float at = Least(Most(shutter, 0.0F), 1.0F) * last;
  const float step = Least(std::floor(at), last - 1.0F);
  return {static_cast<std::size_t>(step), at - step};
}

/// Whether the cone may meet a moving instance nearer than `far`. The scene's tree knows only the
/// box about all places: the vehicle's own contains the sensor.
[[nodiscard]] inline bool MayMeetMoving(const BeamInstance& instance,
                                        const BetweenSteps& steps,
                                        const Cone& window_cone,
                                        float far) {
  const BeamBox& a = instance.window_boxes[steps.before];
  const BeamBox& b = instance.window_boxes[steps.before + 1];
  BeamBox box;
  for (int i = 0; i < 3; ++i) {
    box.lower[i] = (1.0F - steps.part) * a.lower[i] + steps.part * b.lower[i];
    box.upper[i] = (1.0F - steps.part) * a.upper[i] + steps.part * b.upper[i];
  }
  return IsBoxMet(box, window_cone, far);
}

/// Interpolates a moving instance's matrix between its steps, as Embree does.
[[nodiscard]] inline InstancePlace PlaceAt(const BeamInstance& instance,
                                           const BetweenSteps& steps) {
  InstancePlace place{};
  const float part = steps.part;
  const Rows& a = instance.window_from_model[steps.before];
  const Rows& b = instance.window_from_model[steps.before + 1];
  double m[12];
  for (int i = 0; i < 12; ++i) {
    place.window_from_model.m[i] = (1.0F - part) * a.m[i] + part * b.m[i];
    m[i] = static_cast<double>(place.window_from_model.m[i]);
  }
  // The inverse by cofactors, in double, since the translation may be large.
  double inverse[9];
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const int r1 = (k + 1) % 3;
      const int r2 = (k + 2) % 3;
      const int c1 = (i + 1) % 3;
      const int c2 = (i + 2) % 3;
      inverse[3 * i + k] = m[4 * r1 + c1] * m[4 * r2 + c2] - m[4 * r1 + c2] * m[4 * r2 + c1];
    }
  }
  const double det = m[0] * inverse[0] + m[1] * inverse[3] + m[2] * inverse[6];
  for (int i = 0; i < 3; ++i) {
    double shift = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double value = inverse[3 * i + k] / det;
      place.model_from_window.m[4 * i + k] = static_cast<float>(value);
      shift -= value * m[4 * k + 3];
    }
    place.model_from_window.m[4 * i + 3] = static_cast<float>(shift);
  }
  return place;
}

inline void Turn(const Rows& rows, const float* from, float* to) {
  for (std::size_t i = 0; i < 3; ++i) {
    to[i] = rows.m[4 * i] * from[0] + rows.m[4 * i + 1] * from[1] + rows.m[4 * i + 2] * from[2];
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_TRACE_INSTANCE_PLACE_H_
