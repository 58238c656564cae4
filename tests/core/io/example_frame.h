#pragma once

#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "railcast/frame.h"

namespace railcast {

/// Three labels with distinct SemanticKITTI ids.
inline LabelTable ExampleLabels() {
  std::vector<Label> labels(3);
  labels[0].name = "unlabeled";
  labels[1] = {1, "rail", {230, 159, 0}, "Rails", "track", 260, 49};
  labels[2] = {12, "wagon", {213, 94, 0}, "Others", "wagons", 16, 16};
  return LabelTable(labels);
}

/// Returns a frame whose every field has many different values: floats with all their bits in use,
/// every outcome in turn, NaN where there is no point. Equal arguments give equal frames.
inline Frame ExampleFrame(std::uint32_t index, std::uint32_t rows = 6, std::uint32_t columns = 9) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  Frame frame;
  frame.Resize(rows, columns, 1);
  frame.index = index;
  frame.stamp_ns = 100'000'000LL * index;
  frame.world_from_sensor = MakeTransform(RotationFromYawPitchRoll(0.1 + 0.01 * index, 0.02, -0.03),
                                          Vector3(5.3e6 + 0.1 * index, 6e5, 412.25));
  frame.world_from_sensor_end = frame.world_from_sensor;
  frame.duration_ns = 80'000'000U * (rows * columns - 1);
  for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
    const auto words = RandomWords(7, RandomUse::kNoise, index, slot);
    const auto in_turn = static_cast<Outcome>(slot % 10);
    // The eleventh outcome takes turns with another one that has no point.
    const bool is_eleventh = in_turn == Outcome::kSensorDropout && slot / 10 % 2 == 1;
    const Outcome outcome = is_eleventh ? Outcome::kCoverBlocked : in_turn;
    const bool has_point = HasPoint(outcome);
    frame.x[slot] = has_point ? UnitFloat(words[0]) * 300.0F : kNaN;
    frame.y[slot] = has_point ? UnitFloat(words[1]) * -20.0F : kNaN;
    frame.z[slot] = has_point ? UnitFloat(words[2]) * 1e-3F : kNaN;
    frame.range_m[slot] = has_point ? std::hypot(frame.x[slot], frame.y[slot]) : kNaN;
    frame.intensity[slot] = has_point ? 3.0F * UnitFloat(words[3]) : kNaN;
    frame.power_ratio[slot] = UnitFloat(words[3]) / 7.0F;
    frame.time_ns[slot] = slot * 80'000'000U;
    frame.ring[slot] = static_cast<std::uint16_t>(slot / columns);
    frame.column[slot] = slot % columns;
    frame.return_index[slot] = 0;
    frame.return_count[slot] = has_point ? 1 : 0;
    frame.label[slot] = has_point ? (slot % 2 == 0 ? 12U : 1U) : 0U;
    frame.instance[slot] = frame.label[slot] == 12 ? 3U : 0U;
    frame.outcome[slot] = outcome;
    frame.true_range_m[slot] = UnitFloat(words[0]) * 299.0F;
    frame.incidence_rad[slot] = UnitFloat(words[1]);
    frame.material[slot] = static_cast<std::uint16_t>(words[2] >> 16U);
    frame.footprint_share[slot] = has_point ? UnitFloat(words[1]) : kNaN;
    frame.mixed_share[slot] = has_point ? UnitFloat(words[0]) : kNaN;
  }
  return frame;
}

/// The frame as a sensor gives it that measures velocities, too.
inline Frame WithVelocities(Frame frame) {
  frame.has_velocity = true;
  frame.Resize(frame.rows, frame.columns, frame.returns);
  for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
    const auto words = RandomWords(8, RandomUse::kNoise, frame.index, slot);
    frame.true_radial_velocity_mps[slot] = 50.0F * UnitFloat(words[0]) - 25.0F;
    frame.radial_velocity_mps[slot] = HasPoint(frame.outcome[slot])
                                          ? 50.0F * UnitFloat(words[1]) - 25.0F
                                          : std::numeric_limits<float>::quiet_NaN();
  }
  return frame;
}

}  // namespace railcast
