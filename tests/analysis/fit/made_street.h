#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/fit/fit.h"
#include "analysis/fit/trial_sample.h"
#include "analysis/fit/truth_trials.h"
#include "core/io/recording/recording.h"
#include "core/scenario/effects.h"
#include "core/simulate/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {

/// The materials of MakeStreet(): Lambertian or rough, and one with a lobe.
[[nodiscard]] inline std::vector<Material> StreetMaterials() {
  return {{.name = "road", .reflectivity = 0.2, .facet_slope_deg = 30.0},
          {.name = "left_wall", .reflectivity = 0.35, .facet_slope_deg = 15.0},
          {.name = "right_wall", .reflectivity = 0.6},
          {.name = "gate", .reflectivity = 0.1, .facet_slope_deg = 10.0},
          {.name = "board", .reflectivity = 0.5, .specular_f0 = 0.04, .specular_roughness = 0.4}};
}

/// A street of walls 12 m to the left and right, a road 2 m below the sensor and things that face
/// it every 30 m, which the vehicle passes in a wide bend at 47 m/s: all ranges, all incidences.
[[nodiscard]] inline std::shared_ptr<SimpleWorld> MakeStreet() {
  auto world = std::make_shared<SimpleWorld>();
  const auto quad = [](const Vector3& a, const Vector3& u, const Vector3& v) {
    const auto f = [](const Vector3& p) { return Eigen::Vector3f(p.cast<float>()); };
    return Mesh{{f(a), f(a + u), f(a + u + v), f(a + v)}, {{0, 1, 2}, {0, 2, 3}}};
  };
  constexpr double kLength_m = 700.0;
  const Vector3 along(kLength_m, 0, 0);
  const auto add = [&](const Mesh& mesh, std::uint16_t material) {
    world->ground.parts.push_back({mesh, material, 1});
  };
  add(quad({-50, -12, -2}, along, {0, 24, 0}), 1);
  add(quad({-50, 12, -2}, along, {0, 0, 30}), 2);
  add(quad({-50, -12, -2}, along, {0, 0, 30}), 3);
  for (int i = 0; i < 20; ++i) {
    const double x_m = 20.0 + 30.0 * i;
    // On the left and on the right by turns, so that the next is seen, too; more or less slanting.
    const double turn_rad = 0.35 * (i % 4);
    add(quad({x_m, i % 2 == 0 ? 5.0 : -8.0, -2},
             {3.0 * std::sin(turn_rad), 3.0 * std::cos(turn_rad), 0}, {0, 0, 4}),
        i % 3 == 0 ? 5 : 4);
  }
  world->velocity_chunk_mps = Vector3(47.3, -0.61, 0);
  world->yaw_rate_radps = 0.043;
  return world;
}

/// A frame of ours as a recording gives it, all fields known.
[[nodiscard]] inline RecordedFrame AsRecorded(const Frame& frame) {
  RecordedFrame recorded;
  recorded.frame = frame;
  recorded.is_grid = true;
  ForEachField(frame, [&](std::string_view name, std::string_view, const auto&) {
    recorded.fields.emplace(name);
  });
  return recorded;
}

[[nodiscard]] inline SimulatorSpec StreetSpec(std::string_view rung, std::uint64_t seed) {
  SimulatorSpec spec;
  spec.seed = seed;
  spec.effects = EffectsOfRung(rung);
  spec.range_max_m = 250.0;
  return spec;
}

/// The surfaces of MakeStreet() with their shapes, by material.
[[nodiscard]] inline std::vector<FitSurface> StreetSurfaces() {
  std::vector<FitSurface> surfaces{MakeLambertSurface("none")};
  for (const Material& material : StreetMaterials()) {
    surfaces.push_back(MakeShapedSurface(material, 905, 0.0));
  }
  return surfaces;
}

/// The trials of some frames of the street.
[[nodiscard]] inline std::vector<Trial> StreetTrials(const SimulatorSpec& spec,
                                                     std::uint32_t num_frames) {
  const ScanPattern pattern = MakeRaster(60.0, 30.0, 0.5);
  const std::optional<ScanTable> scan = MakeScanTable(pattern);
  const SensorFacts facts{spec.range_min_m, spec.range_max_m, spec.beam, &*scan};
  Simulator simulator(MakeStreet(), pattern, MaterialLibrary(StreetMaterials()), spec, 0);
  TrialSample sample;
  Frame frame;
  for (std::uint32_t index = 0; index < num_frames; ++index) {
    simulator.Scan(index, frame);
    ForEachTruthTrial(AsRecorded(frame), facts, [&](const Trial& trial, std::size_t slot) {
      sample.Add(trial, (std::uint64_t{index} << 32U) + slot);
    });
  }
  return sample.trials();
}

/// The parameter of a result at a place, or with a title.
[[nodiscard]] inline const FittedParameter& ParameterOf(const FitResult& result,
                                                        std::string_view place_or_title) {
  for (const FittedParameter& parameter : result.parameters) {
    if (parameter.place == place_or_title || parameter.title == place_or_title) return parameter;
  }
  throw std::out_of_range(std::string(place_or_title));
}

[[nodiscard]] inline const SurfaceFit& SurfaceOf(const FitResult& result, std::string_view name) {
  for (const SurfaceFit& surface : result.surfaces) {
    if (surface.name == name) return surface;
  }
  throw std::out_of_range(std::string(name));
}

}  // namespace railcast
