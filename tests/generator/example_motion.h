#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/generator/example_run.h"

namespace railcast {

/// An example run with an IMU, a receiver and an odometer.
inline SequenceSpec RunWithMotion(const std::filesystem::path& directory,
                                  const std::string& format = "pcd") {
  SequenceSpec spec = ExampleRun(directory, format);
  spec.motion_sensors.emplace();
  spec.motion_sensors->imus.emplace_back();
  spec.motion_sensors->gnss.emplace_back();
  spec.motion_sensors->odometers.emplace_back();
  return spec;
}

/// Three samples of the IMU and two of the odometer in each frame, and one of the receiver in those
/// with even numbers.
inline MotionSamples ExampleMotion(std::uint32_t frame) {
  MotionSamples samples;
  samples.imus.resize(1);
  samples.gnss.resize(1);
  samples.odometers.resize(1);
  for (int i = 0; i < 3; ++i) {
    ImuSample& sample = samples.imus[0].emplace_back();
    sample.time_ns = 1000 * std::int64_t{frame} + i;
    sample.specific_force_mps2 = {0.1 * frame, 0.0, 9.8};
  }
  if (frame % 2 == 0) {
    GnssSample& sample = samples.gnss[0].emplace_back();
    sample.time_ns = 1000 * std::int64_t{frame};
    sample.sky_share = 0.125;
    sample.true_position_m = {1.5, 2.5, -0.0};
  }
  for (int i = 0; i < 2; ++i) {
    samples.odometers[0].push_back({.time_ns = 1000 * std::int64_t{frame} + 500 * i,
                                    .pulses = 17 * std::int64_t{frame} + i,
                                    .distance_m = 0.25});
  }
  return samples;
}

inline SequenceResult MakeMotionRun(const SequenceSpec& spec,
                                    const SequenceHooks& hooks = NoHooks()) {
  const BeginFrame begin = [](std::uint32_t index) -> FrameJob {
    return [index](MadeFrame& made) {
      made.objects.clear();
      MakeExampleFrame(index, made.frame, made.objects);
      made.motion = ExampleMotion(index);
    };
  };
  return RunSequence(spec, begin, hooks, FramesAtOnce{});
}

}  // namespace railcast
