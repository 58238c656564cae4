#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/transform.h"
#include "core/frame/outcome.h"

namespace railcast {

/// One complete scan: for every firing what came back, why nothing came back, and what was true.
///
/// Struct of arrays. Slot = row * width + column * returns + return_index, row 0 the lowest
/// channel; width = columns * returns. Patterns that are no grid have one row. Absence is NaN.
/// x, y, z are in the frame that `output.frame` names (the sensor's at the firing's own time by
/// default: rolling shutter as a real sensor delivers it).
struct Frame {
  std::uint32_t index{};                                ///< Frame number in the run.
  std::int64_t stamp_ns{};                              ///< Simulation time of firing 0.
  Transform world_from_sensor = Transform::Identity();  ///< At the stamp.
  /// At the last firing. Over one scan the pose changes nearly linearly: what lies between is
  /// interpolated.
  Transform world_from_sensor_end = Transform::Identity();
  std::uint32_t duration_ns{};  ///< From the stamp to the last firing.
  std::uint32_t rows{};         ///< Channels.
  std::uint32_t columns{};      ///< Azimuth steps.
  std::uint32_t returns{1};     ///< Slots per firing.

  // The measurement.
  std::vector<float> x, y, z;          ///< m
  std::vector<float> intensity;        ///< Effective reflectance; NaN in rung geometry.
  std::vector<float> power_ratio;      ///< Received power / threshold; NaN in rung geometry.
  std::vector<float> range_m;          ///< Measured.
  std::vector<std::uint32_t> time_ns;  ///< Since the stamp.
  std::vector<std::uint16_t> ring;     ///< Channel, 0 the lowest.
  std::vector<std::uint32_t> column;   ///< Azimuth index.
  std::vector<std::uint8_t> return_index;
  std::vector<std::uint8_t> return_count;

  // The truth: what the beam hit first, whether or not it was detected.
  std::vector<std::uint32_t> label;     ///< Of labels.json; 0 = nothing was hit.
  std::vector<std::uint32_t> instance;  ///< 0 = stuff; see SceneObject::instance.
  std::vector<Outcome> outcome;
  std::vector<float> true_range_m;      ///< Before noise.
  std::vector<float> incidence_rad;     ///< Between the beam and the surface normal.
  std::vector<std::uint16_t> material;  ///< Index into the material library; 0 = none.
  std::vector<float> footprint_share;   ///< Of the beam in this echo; NaN on rungs without beams.
  /// Of the beam beside the surface that takes most of it, 0.5 m or more apart or in the sky: what
  /// makes a pixel mixed. NaN likewise.
  std::vector<float> mixed_share;

  [[nodiscard]] std::uint32_t width() const { return columns * returns; }
  [[nodiscard]] std::size_t num_slots() const { return std::size_t{rows} * width(); }

  /// Gives every field num_slots() elements; keeps the memory where the shape stays.
  void Resize(std::uint32_t new_rows, std::uint32_t new_columns, std::uint32_t new_returns);
};

/// Calls `visit(name, unit, values)` for every per-slot field, in the order files store them.
/// The one table that sinks, viewer and documentation share. `F` is Frame or const Frame.
template <typename F, typename Visitor>
void ForEachField(F& frame, Visitor&& visit) {
  visit("x", "m", frame.x);
  visit("y", "m", frame.y);
  visit("z", "m", frame.z);
  visit("intensity", "", frame.intensity);
  visit("power_ratio", "", frame.power_ratio);
  visit("range_m", "m", frame.range_m);
  visit("time_ns", "ns", frame.time_ns);
  visit("ring", "", frame.ring);
  visit("column", "", frame.column);
  visit("return_index", "", frame.return_index);
  visit("return_count", "", frame.return_count);
  visit("label", "", frame.label);
  visit("instance", "", frame.instance);
  visit("outcome", "", frame.outcome);
  visit("true_range_m", "m", frame.true_range_m);
  visit("incidence_rad", "rad", frame.incidence_rad);
  visit("material", "", frame.material);
  visit("footprint_share", "", frame.footprint_share);
  visit("mixed_share", "", frame.mixed_share);
}

}  // namespace railcast
