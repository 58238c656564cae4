#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/parallelism.h"
#include "core/base/units.h"
#include "core/detect/detector/effect_table.h"
#include "core/rail/world/world_draft.h"
#include "core/scenario/build_faults.h"
#include "core/scenario/sensors.h"
#include "core/scenario/shared_scenery.h"
#include "core/simulate/output_axes.h"
#include "railcast/effects.h"
#include "railcast/lidar.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

// Builds something from the spec at `pointer` of the scenario. Its faults name the file that the
// spec was read from.
template <class Builder>
auto Located(const ScenarioSpec& spec,
             std::string_view pointer,
             ErrorList& errors,
             const Builder& build) {
  ErrorList faults;
  auto built = Attempt("", faults, build);
  for (const Fault& fault : faults.faults()) errors.Add(spec.sources.Locate(fault, pointer));
  return built;
}

std::optional<ScanPattern> TryPattern(const ScenarioSpec& spec,
                                      const std::string& sensor_pointer,
                                      const ScanSpec& scan,
                                      ErrorList& errors) {
  return Located(spec, sensor_pointer + "/scan", errors, [&] {
    return WithinMemory([] { return "building the scan pattern"; },
                        [&] { return BuildScanPattern(scan); });
  });
}

// Checks that float32 can represent the points of frame 0 in the axes of the output.
void CheckOutput(const ScenarioSpec& spec, ErrorList& errors) {
  if (spec.output.frame != OutputFrame::kWorld) return;
  const auto world = MakeWorld(spec);
  for (const auto& [lidar, pointer] : SensorsOf(spec)) {
    const Transform vehicle_from_sensor = VehicleFromSensor(lidar.mount);
    const std::int64_t stamp_ns = std::llround(lidar.scan.phase_s * kNsPerS);
    const Transform world_from_sensor = world->WorldFromVehicle(stamp_ns) * vehicle_from_sensor;
    static_cast<void>(Attempt("", errors, [&] {
      return OutputAxes(spec.output, spec.sources.Place("/output/origin_m"), {vehicle_from_sensor},
                        Transform::Identity(), world_from_sensor);
    }));
  }
}

// Labels and materials that the effects, as opposed to the world, look up by name.
struct EffectNamesInUse {
  ClutterLabels labels;
  std::vector<std::vector<std::uint32_t>> footprint_labels;  ///< By sensor.
  std::uint16_t snow_material{};
};

/// Whether a label is that of echoes which an effect adds and no surface sends.
bool IsOfEchoesAlone(const std::string& label) {
  return std::ranges::any_of(EffectTable(), [&](const Effect& effect) {
    return std::ranges::find(effect.labels, label, &EffectLabel::name) != effect.labels.end();
  });
}

std::optional<EffectNamesInUse> TryNames(const ScenarioSpec& spec, ErrorList& errors) {
  return Located(spec, "", errors, [&] {
    const LabelTable labels(spec.labels);
    // Conflicts between effects are reported where the effects are read.
    const EffectSet effects = SwitchedEffects(spec);
    EffectNamesInUse names;
    ErrorList unknown;
    const auto ids_of = [&](const std::vector<std::string>& classes, const std::string& pointer) {
      for (std::size_t i = 0; i < classes.size(); ++i) {
        if (!IsOfEchoesAlone(classes[i])) continue;
        unknown.Add({pointer + '/' + std::to_string(i), "must be a class of surfaces",
                     '"' + ShownText(classes[i]) + '"'});
      }
      const auto ids = Attempt("", unknown, [&] { return labels.Ids(classes, pointer); });
      return ids.value_or(std::vector<std::uint32_t>{});
    };
    // Sensors differ in the labels that they need, not in the identifiers of these.
    for (const SensorPlace& sensor : SensorsOf(spec)) {
      names.labels = ClutterLabelsOf(labels, DetectorSpecOf(spec, sensor.lidar, effects));
      names.footprint_labels.push_back(
          ids_of(sensor.lidar.beam.footprint_of, sensor.pointer + "/beam/footprint_of"));
    }
    ids_of(spec.tolerance.of, "/tolerance/of");
    unknown.ThrowIfAny();
    if (spec.weather.snow_cover > 0.0) {
      names.snow_material = MaterialLibrary(spec.materials).Index("snow");
    }
    return names;
  });
}

}  // namespace

Transform VehicleFromSensor(const MountSpec& mount) {
  return MakeTransform(
      RotationFromYawPitchRoll(RadFromDeg(mount.yaw_deg), RadFromDeg(mount.pitch_deg),
                               RadFromDeg(mount.roll_deg)),
      {mount.position_m[0], mount.position_m[1], mount.position_m[2]});
}

Transform NominalFromTrue(const MountErrorSpec& error) {
  return MakeTransform(
      RotationFromYawPitchRoll(RadFromDeg(error.yaw_deg), RadFromDeg(error.pitch_deg),
                               RadFromDeg(error.roll_deg)),
      {error.position_m[0], error.position_m[1], error.position_m[2]});
}

void AddBuildFaults(const ScenarioSpec& spec, const UnknownPlaces& unknown, ErrorList& errors) {
  // A spec left at its default was not read, and its fault has been reported already. It is on the
  // heap because GCC 12 suspects members of a local one of being uninitialized.
  const auto unread = std::make_unique<const LidarSpec>();
  for (const auto& [lidar, pointer] : SensorsOf(spec)) {
    const bool is_read = lidar != *unread;
    if (!is_read || !unknown.IsKnown(pointer + "/scan/pattern")) continue;
    // If the rate is unknown, use the slowest that 32-bit times in nanoseconds allow: a pattern
    // that breaks a rule at this rate does so at every rate.
    constexpr double kSlowestRate_hz = 1e9 / 4'294'967'295.0;
    ScanSpec known = lidar.scan;
    if (!unknown.IsKnown(pointer + "/scan/rate_hz")) {
      const auto* const table = std::get_if<FiringTableSpec>(&known.pattern);
      // The period alone says where the frames of a longer table begin.
      if (table != nullptr && table->frames > 1) continue;
      known.rate_hz = kSlowestRate_hz;
    }
    known.phase_s = 0.0;  // The reader reports a wrong one.
    static_cast<void>(TryPattern(spec, pointer, known, errors));
  }
  const LabelTable labels(spec.labels);
  const MaterialLibrary materials(spec.materials);
  WorldFaults faults{{}, unknown};
  static_cast<void>(DraftWorld({spec.world, spec.vehicle, labels, materials}, faults));
  // The world is built from two specs, so that its pointers are already relative to the scenario:
  // "/world/..." and "/vehicle/...".
  for (const Fault& fault : faults.errors.faults()) errors.Add(spec.sources.Locate(fault, ""));
  if (unknown.IsKnown("/labels")) static_cast<void>(TryNames(spec, errors));
}

namespace {

std::shared_ptr<const RailWorld> MakeWorld(const ScenarioSpec& spec, SharedLines* shared) {
  ErrorList errors;
  const auto doing = [&] {
    return "building the world (" + std::to_string(spec.world.objects.size()) + " objects)";
  };
  const auto make = [&] {
    return WithinMemory(doing, [&] {
      return std::make_shared<const RailWorld>(spec.world, spec.vehicle, LabelTable(spec.labels),
                                               MaterialLibrary(spec.materials), spec.world.seed,
                                               shared);
    });
  };
  const auto world = Located(spec, "", errors, make);
  errors.ThrowIfAny();
  return *world;
}

std::vector<std::unique_ptr<Simulator>> MakeSimulators(const ScenarioSpec& spec,
                                                       int num_threads,
                                                       const std::string& isa,
                                                       SharedScenery* shared) {
  ErrorList errors;
  const std::vector<SensorPlace> sensors = SensorsOf(spec);
  std::vector<std::optional<ScanPattern>> patterns;
  for (const auto& [lidar, pointer] : sensors) {
    patterns.push_back(TryPattern(spec, pointer, lidar.scan, errors));
  }
  const auto world = Attempt(
      "", errors, [&] { return MakeWorld(spec, shared == nullptr ? nullptr : &shared->lines); });
  const auto effects = Located(spec, "", errors, [&] { return EffectsOf(spec); });
  const auto names = effects ? TryNames(spec, errors) : std::nullopt;
  errors.ThrowIfAny();

  const MaterialLibrary materials(spec.materials);
  const auto stock = shared == nullptr ? std::make_shared<TraceStock>(isa) : shared->stock;
  const auto store = std::make_shared<SceneStore>(*world, materials, stock);
  std::vector<std::unique_ptr<Simulator>> simulators;
  const auto make = [&] {
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      const LidarSpec& lidar = sensors[i].lidar;
      SimulatorSpec simulator{.detector = DetectorSpecOf(spec, lidar, *effects),
                              .vehicle_from_sensor = VehicleFromSensor(lidar.mount),
                              .nominal_from_true = NominalFromTrue(lidar.mount_error),
                              .output = spec.output,
                              .origin_place = spec.sources.Place("/output/origin_m"),
                              .snow_material = names->snow_material,
                              .has_full_detail = spec.world.detail == SceneDetail::kFull,
                              .isa = isa};
      simulator.detector.clutter_labels = names->labels;
      simulator.detector.footprint_labels = names->footprint_labels[i];
      const std::size_t num_firings = patterns[i]->num_firings();
      const auto doing = [&] {
        return "making the simulator of " + std::to_string(num_firings) + " firings a frame";
      };
      simulators.push_back(WithinMemory(doing, [&] {
        return std::make_unique<Simulator>(store, std::move(*patterns[i]), materials, simulator,
                                           num_threads);
      }));
    }
  };
  const auto allowed = AllowThreads(num_threads);
  // The first frame needs the plants, too. They are made by threads that have nothing else to do.
  tbb::task_arena arena(num_threads > 0 ? num_threads : tbb::task_arena::automatic);
  arena.execute([&] { tbb::parallel_invoke([&] { (*world)->PreparePlants(); }, make); });
  return simulators;
}

}  // namespace

std::shared_ptr<const RailWorld> MakeWorld(const ScenarioSpec& spec) {
  return MakeWorld(spec, nullptr);
}

std::vector<std::unique_ptr<Simulator>> MakeSimulators(const ScenarioSpec& spec,
                                                       int num_threads,
                                                       const std::string& isa) {
  return MakeSimulators(spec, num_threads, isa, nullptr);
}

std::vector<std::unique_ptr<Simulator>> MakeSimulators(const ScenarioSpec& spec,
                                                       int num_threads,
                                                       SharedScenery& shared) {
  return MakeSimulators(spec, num_threads, shared.isa, &shared);
}

std::unique_ptr<Simulator> MakeSimulator(const ScenarioSpec& spec,
                                         int num_threads,
                                         const std::string& isa) {
  return std::move(MakeSimulators(PickSensor(spec, {}), num_threads, isa).front());
}

void UseWeather(const ScenarioSpec& scenario, const WeatherSpec& weather, SimulatorSpec& spec) {
  DetectorSpec detector = spec.detector;
  detector.weather = weather;
  detector.clutter_labels = ClutterLabelsOf(LabelTable(scenario.labels), detector);
  spec.snow_material =
      weather.snow_cover > 0.0 ? MaterialLibrary(scenario.materials).Index("snow") : 0;
  spec.detector = detector;
}

std::vector<std::string> CheckScenario(const std::filesystem::path& file) {
  ErrorList errors;
  const auto spec = Attempt("", errors, [&] { return ReadScenario(file); });
  if (spec) AddBuildFaults(*spec, {}, errors);
  if (errors.empty()) CheckOutput(*spec, errors);
  return errors.lines();
}

}  // namespace railcast
