#include <optional>
#include <utility>

#include "core/base/attempt.h"
#include "core/base/units.h"
#include "core/detect/detector.h"
#include "core/rail/rail_world.h"
#include "core/rail/world_draft.h"
#include "core/scan/scan_pattern.h"
#include "core/scenario/build_faults.h"
#include "core/scenario/effect_names.h"
#include "core/scenario/scenario.h"

namespace railcast {
namespace {

// Builds something from the spec that stands at `pointer` of the scenario, and lets its faults name
// the file that the spec was read from.
template <class Builder>
auto Located(const ScenarioSpec& spec,
             std::string_view pointer,
             ErrorList& errors,
             const Builder& build) {
  ErrorList faults;
  auto built = Attempt("", faults, build);
  for (const std::string& line : faults.lines()) errors.Add(spec.sources.Locate(line, pointer));
  return built;
}

std::optional<ScanPattern> TryPattern(const ScenarioSpec& spec, ErrorList& errors) {
  return Located(spec, "/lidar/scan", errors, [&] { return BuildScanPattern(spec.lidar.scan); });
}

// What the effects call things by name, besides the world.
struct EffectNamesInUse {
  ClutterLabels labels;
  std::uint16_t snow_material{};
};

std::optional<EffectNamesInUse> TryNames(const ScenarioSpec& spec, ErrorList& errors) {
  return Located(spec, "", errors, [&] {
    const LabelTable labels(spec.labels);
    EffectNamesInUse names;
    names.labels.snow = labels.Id("snow");
    // Whether they go together is said where they are read.
    if (IsPhysical(SwitchedEffects(spec))) {
      names.labels.rain = labels.Id("rain");
      names.labels.fog = labels.Id("fog");
      names.labels.false_alarm = labels.Id("false_alarm");
    }
    if (spec.weather.snow_cover > 0.0) {
      names.snow_material = MaterialLibrary(spec.materials).Index("snow");
    }
    return names;
  });
}

Transform VehicleFromSensor(const MountSpec& mount) {
  return MakeTransform(
      RotationFromYawPitchRoll(RadFromDeg(mount.yaw_deg), RadFromDeg(mount.pitch_deg),
                               RadFromDeg(mount.roll_deg)),
      {mount.position_m[0], mount.position_m[1], mount.position_m[2]});
}

}  // namespace

void AddBuildFaults(const ScenarioSpec& spec, const UnknownPlaces& unknown, ErrorList& errors) {
  if (unknown.IsKnown("/lidar/scan/pattern")) {
    // Times are 32 bits of nanoseconds: what breaks a rule at this rate does so at every rate.
    constexpr double kSlowestRate_hz = 1e9 / 4'294'967'295.0;
    ScenarioSpec known = spec;
    if (!unknown.IsKnown("/lidar/scan/rate_hz")) known.lidar.scan.rate_hz = kSlowestRate_hz;
    static_cast<void>(TryPattern(known, errors));
  }
  const LabelTable labels(spec.labels);
  const MaterialLibrary materials(spec.materials);
  WorldFaults faults{{}, unknown};
  static_cast<void>(DraftWorld({spec.world, spec.vehicle, labels, materials}, faults));
  // The world has two specs, so its pointers are the scenario's: "/world/..." and "/vehicle/...".
  for (const std::string& line : faults.errors.lines()) errors.Add(spec.sources.Locate(line, ""));
  if (unknown.IsKnown("/labels")) static_cast<void>(TryNames(spec, errors));
}

std::shared_ptr<const RailWorld> MakeWorld(const ScenarioSpec& spec) {
  ErrorList errors;
  const auto make = [&] {
    return std::make_shared<const RailWorld>(spec.world, spec.vehicle, LabelTable(spec.labels),
                                             MaterialLibrary(spec.materials), spec.world.seed);
  };
  const auto world = Located(spec, "", errors, make);
  errors.ThrowIfAny();
  return *world;
}

std::unique_ptr<Simulator> MakeSimulator(const ScenarioSpec& spec,
                                         int num_threads,
                                         const std::string& isa) {
  ErrorList errors;
  auto pattern = TryPattern(spec, errors);
  const auto world = Attempt("", errors, [&] { return MakeWorld(spec); });
  const auto effects = Located(spec, "", errors, [&] { return EffectsOf(spec); });
  const auto names = effects ? TryNames(spec, errors) : std::nullopt;
  errors.ThrowIfAny();

  SimulatorSpec simulator;
  simulator.seed = spec.seed;
  simulator.range_min_m = spec.lidar.range_min_m;
  simulator.range_max_m = spec.lidar.range_max_m;
  simulator.vehicle_from_sensor = VehicleFromSensor(spec.lidar.mount);
  simulator.effects = *effects;
  simulator.plausibility = spec.lidar.plausibility;
  simulator.weather = spec.weather;
  simulator.output = spec.output;
  simulator.isa = isa;
  simulator.beam = spec.lidar.beam;
  simulator.receiver = spec.lidar.receiver;
  simulator.clutter_labels = names->labels;
  simulator.snow_material = names->snow_material;
  return std::make_unique<Simulator>(*world, std::move(*pattern), MaterialLibrary(spec.materials),
                                     simulator, num_threads);
}

std::vector<std::string> CheckScenario(const std::filesystem::path& file) {
  ErrorList errors;
  const auto spec = Attempt("", errors, [&] { return ReadScenario(file); });
  if (spec) AddBuildFaults(*spec, {}, errors);
  return errors.lines();
}

}  // namespace railcast
