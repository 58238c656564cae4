#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/fidelity/frame_comparison.h"
#include "railcast/effects.h"
#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/scan_once.h"

namespace railcast {

/// Sub-rays per beam of the reference in these tests.
inline constexpr int kReferenceSubRays = 256;

/// The published raster and the presets of real sensors.
[[nodiscard]] inline std::vector<std::string> ScannedSensors() {
  return {"vir2rail", "vlp16", "hdl32e", "vlp32c", "hdl64e", "pandar64", "vls128", "xt32", "qt128"};
}

/// Reads scenarios/minimal.json with scenarios/sensors/NAME.json as its sensor.
[[nodiscard]] inline ScenarioSpec ReadMinimalWith(const std::string& sensor) {
  const std::string scenarios = RAILCAST_SOURCE_DIR "/scenarios/";
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "scenario.json";
  std::ofstream(file) << R"({"version": 1, "file": ")" << scenarios
                      << R"(minimal.json", "lidar": ")" << scenarios << "sensors/" << sensor
                      << R"(.json"})";
  return ReadScenario(file);
}

/// A part of a sensor's view about straight ahead, in degrees.
struct SectorSpec {
  double half_azimuth_deg{};
  double low_deg{};
  double high_deg{};
};

/// The scan reduced to the firings of a sector; their spacing, offsets and times are the sensor's
/// own. A raster stays symmetric about the horizon; a table of firings stays whole.
[[nodiscard]] inline ScanSpec CutSector(ScanSpec scan, const SectorSpec& sector) {
  if (auto* raster = std::get_if<RasterSpec>(&scan.pattern)) {
    const auto reduce = [](double& fov_deg, double half_deg) {
      fov_deg = std::min(fov_deg, 2.0 * std::ceil(half_deg));
    };
    reduce(raster->horizontal_fov_deg, sector.half_azimuth_deg);
    reduce(raster->vertical_fov_deg, std::max(std::abs(sector.low_deg), std::abs(sector.high_deg)));
    return scan;
  }
  if (std::holds_alternative<FiringTableSpec>(scan.pattern)) return scan;
  auto& spinning = std::get<SpinningSpec>(scan.pattern);
  const double step_deg = 360.0 * scan.rate_hz * 1e-6 * spinning.cycle_us;
  spinning.columns = static_cast<std::uint32_t>(2.0 * sector.half_azimuth_deg / step_deg);
  spinning.start_azimuth_deg = -sector.half_azimuth_deg;
  std::erase_if(spinning.channels, [&](const ChannelSpec& channel) {
    return channel.elevation_deg < sector.low_deg || channel.elevation_deg > sector.high_deg;
  });
  double first_us = spinning.channels.front().time_us;
  for (const ChannelSpec& channel : spinning.channels) {
    first_us = std::min(first_us, channel.time_us);
  }
  for (ChannelSpec& channel : spinning.channels) channel.time_us -= first_us;
  return scan;
}

/// The firings of a pattern whose directions `is_wanted` holds of, in one row.
template <class Wanted>
[[nodiscard]] ScanPattern Only(const ScanPattern& all, const Wanted& is_wanted) {
  Check(all.repeats() && all.origin_x_m.empty(),
        "the beams leave at the origin, in every frame alike");
  ScanPattern some;
  some.rate_hz = all.rate_hz;
  some.phase_ns = all.phase_ns;
  some.rows = 1;
  for (std::size_t i = 0; i < all.num_firings(); ++i) {
    if (!is_wanted(DirectionOf(all, i))) continue;
    some.direction_x.push_back(all.direction_x[i]);
    some.direction_y.push_back(all.direction_y[i]);
    some.direction_z.push_back(all.direction_z[i]);
    some.time_ns.push_back(all.time_ns[i]);
    some.row.push_back(0);
    some.packet_order.push_back(some.columns);
    some.column.push_back(some.columns++);
  }
  while (some.packet_order.size() % kPacketSize != 0) some.packet_order.push_back(some.columns - 1);
  return some;
}

/// The spec of a sensor with a set of effects, without random errors of ranges. The pointing has no
/// jitter, so that every beam's place is known.
[[nodiscard]] inline SimulatorSpec SpecOf(const LidarSpec& lidar, const EffectSet& effects) {
  SimulatorSpec spec{.detector = {.seed = 7,
                                  .range_min_m = lidar.range_min_m,
                                  .range_max_m = lidar.range_max_m,
                                  .effects = WithoutRangeErrors(effects),
                                  .plausibility = lidar.plausibility,
                                  .beam = lidar.beam,
                                  .receiver = lidar.receiver}};
  spec.detector.effects.pointing_jitter = false;
  spec.detector.beam.reference_rays = kReferenceSubRays;
  return spec;
}

/// The same frame of a scene by a rung and by the reference.
struct FramePair {
  Frame rung;
  Frame reference;
};

[[nodiscard]] inline FramePair ScanBoth(std::shared_ptr<const World> world,
                                        const ScanPattern& pattern,
                                        const MaterialLibrary& materials,
                                        const LidarSpec& lidar,
                                        Fidelity rung) {
  FramePair pair;
  const SimulatorSpec spec = SpecOf(lidar, EffectsOfRung(rung));
  Simulator simulator(std::move(world), pattern, materials, spec, 0);
  simulator.Scan(0, pair.rung);
  simulator.Use(SpecOf(lidar, YardstickEffects()));
  simulator.Scan(0, pair.reference);
  return pair;
}

}  // namespace railcast
