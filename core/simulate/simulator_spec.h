#pragma once

#include <cstdint>
#include <string>

#include "core/base/transform.h"
#include "core/detect/detector_spec.h"
#include "core/frame/output_spec.h"

namespace railcast {

/// What a simulation depends on besides the world, the scan pattern and the frame index.
struct SimulatorSpec {
  std::uint64_t seed = 1;
  double range_min_m = 0.5;
  double range_max_m = 300.0;
  Transform vehicle_from_sensor = Transform::Identity();
  EffectSet effects{};
  PlausibilitySpec plausibility{};
  BeamSpec beam{};
  ReceiverSpec receiver{};
  WeatherSpec weather{};
  OutputSpec output{};
  std::string origin_place = "/output/origin_m";  ///< What faults call it.
  ClutterLabels clutter_labels{};
  std::uint16_t snow_material{};  ///< Of what covers surfaces in snow; 0 = nothing does.
  std::string isa{};              ///< Embree's instruction set to force; empty = the best there is.
};

}  // namespace railcast
