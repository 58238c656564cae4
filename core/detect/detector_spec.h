#pragma once

#include <cstdint>

#include "core/detect/detect_spec.h"
#include "core/scene/material.h"

namespace railcast {

/// What clutter is called.
struct ClutterLabels {
  std::uint32_t rain{};
  std::uint32_t snow{};
  std::uint32_t fog{};
  std::uint32_t false_alarm{};
};

/// What a Detector, its clutter and its wide beams depend on.
struct DetectorSpec {
  std::uint64_t seed = 1;
  double range_min_m = 0.5;
  double range_max_m = 300.0;
  std::uint32_t num_channels = 1;
  EffectSet effects{};
  PlausibilitySpec plausibility{};
  BeamSpec beam{};
  ReceiverSpec receiver{};
  WeatherSpec weather{};
  SurfaceOptics snow{};  ///< Of what covers surfaces.
  ClutterLabels labels{};
};

}  // namespace railcast
