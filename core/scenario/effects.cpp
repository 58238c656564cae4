#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/text.h"
#include "core/detect/detector/effect_table.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/table_models.h"
#include "core/scenario/describe_lidar.h"
#include "core/scenario/describe_weather.h"
#include "core/scenario/json_rules.h"
#include "core/scenario/json_text.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// The archive that checks (see describe_scenario.h): holds the numbers of a struct that was made
/// in C++ against the rules of its description. A fault's place is a JSON pointer:
/// "/beam/wavelength_nm: must be 905 or 1550 (got 1064)".
class SpecChecker {
 public:
  SpecChecker(std::string pointer, ErrorList& errors)
      : pointer_(std::move(pointer)), errors_(errors) {}

  template <class T, class Rule = Anything>
  void Required(std::string_view key, T& value, const char* /*doc*/, const Rule& rule = {}) {
    const std::string place = pointer_ + PointerStep(key);
    const std::size_t num_faults = errors_.faults().size();
    CheckValue(place, value, rule);
    if (errors_.faults().size() == num_faults) sound_[std::string(key)] = TextOf(value);
  }
  template <class T, class Rule = Anything>
  void Optional(std::string_view key, T& value, const char* doc, const Rule& rule = {}) {
    Required(key, value, doc, rule);
  }

  // Of files only: another way to give a value.
  void OneOfTwo(std::string_view, std::string_view) {}
  void Alternative(std::string_view, double, const Multiple&, const char*, const Limits&) {}

  void Ensure(const std::vector<std::string>& keys, bool holds, const std::string& rule) {
    const auto is_sound = [&](const std::string& key) { return sound_.contains(key); };
    if (holds || !std::ranges::all_of(keys, is_sound)) return;
    errors_.Add({pointer_ + PointerStep(keys.front()), rule, sound_.at(keys.front())});
  }

 private:
  template <class T>
  [[nodiscard]] static std::string TextOf(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      return NumberText(value);
    } else if constexpr (requires { value.has_value(); }) {
      return value ? TextOf(*value) : "";
    } else {
      return "";
    }
  }
  template <class T, class Rule>
  void CheckValue(const std::string& place, T& value, const Rule& rule) {
    if constexpr (requires { value.has_value(); }) {
      if (value) CheckValue(place, *value, rule);
    } else if constexpr (kIsArray<T>) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        CheckValue(place + "/" + std::to_string(i), value[i], rule);
      }
    } else if constexpr (std::is_class_v<T>) {
      SpecChecker checker(place, errors_);
      Describe(checker, value);
    } else if constexpr (!std::is_same_v<Rule, Anything>) {
      if (const auto broken = Broken(rule, value)) errors_.Add({place, *broken, NumberText(value)});
    }
  }

  std::string pointer_;
  ErrorList& errors_;
  std::map<std::string, std::string> sound_;  // The values that break no rule, by key.
};

// Whether wagons are made of it, which a command may place where the scenario has none. By name,
// since most scenarios never need the table of models.
bool IsWagonMaterial(std::string_view name) {
  return name == "wagon_paint" || name == "wheel_steel";
}

const char* NameOfSwitch(bool EffectSet::*is_on) {
  for (const Effect& effect : EffectTable()) {
    if (effect.is_on == is_on) return effect.name;
  }
  Check(false, "every effect has a row in the table of effects");
  return nullptr;
}

// The first effect that is on and belongs to only the published or only the physical model; null if
// there is none.
const char* FirstOfModel(const EffectSet& effects, bool is_published) {
  for (const Effect& effect : EffectTable()) {
    const bool is_plausible = IsInRung(effect, Fidelity::kPlausibility);
    const bool is_physical = !is_plausible || IsInRung(effect, Fidelity::kSurface);
    const bool is_of_model = is_published ? !is_physical : !is_plausible;
    if (effects.*effect.is_on && is_of_model) return effect.name;
  }
  return nullptr;
}

}  // namespace

EffectSet EffectsOfRung(Fidelity rung) {
  for (const Fidelity known : kRungs) {
    if (known == rung) return EffectsInRung(rung);
  }
  std::vector<std::string> names;
  for (const Fidelity known : kRungs) names.emplace_back(NameOf(known));
  throw InputError("fidelity: must be " + InWords(names) + " (got " + Quoted(NameOf(rung)) + ")");
}

EffectSet SwitchedEffects(const ScenarioSpec& spec) {
  EffectSet effects =
      EffectsOfRung(spec.fidelity == Fidelity::kAuto ? Fidelity::kFootprint : spec.fidelity);
  for (const auto& [name, is_on] : spec.effects) {
    if (const Effect* const effect = FindEffect(name)) effects.*effect->is_on = is_on;
  }
  return effects;
}

std::optional<std::string> ConflictIn(const EffectSet& effects) {
  const char* const published = FirstOfModel(effects, true);
  const char* const physical = FirstOfModel(effects, false);
  if (published != nullptr && physical != nullptr) {
    return Quoted(published) + " of the published model and " + Quoted(physical) +
           " of physics must not both be on";
  }
  for (const Effect& effect : EffectTable()) {
    if (!(effects.*effect.is_on)) continue;
    if (effect.needed != nullptr && !(effects.*effect.needed)) {
      return Quoted(effect.name) + " must not be on without " + Quoted(NameOfSwitch(effect.needed));
    }
    if (effect.excluded != nullptr && effects.*effect.excluded) {
      return Quoted(effect.name) + " and " + Quoted(NameOfSwitch(effect.excluded)) +
             " must not both be on";
    }
  }
  return std::nullopt;
}

EffectSet EffectsOf(const ScenarioSpec& spec) {
  ErrorList errors;
  for (const auto& [name, is_on] : spec.effects) {
    if (FindEffect(name) != nullptr) continue;
    errors.Add({"/effects", Unknown("effect " + Quoted(name), name, EffectNames()), ""});
  }
  errors.ThrowIfAny();
  const EffectSet effects = SwitchedEffects(spec);
  if (const auto conflict = ConflictIn(effects)) throw InputError({{"/effects", *conflict, ""}});
  return effects;
}

std::uint64_t SensorSeed(std::uint64_t seed, const std::string& sensor_name) {
  if (sensor_name.empty()) return seed;
  std::uint64_t hash = 0xCBF29CE484222325ULL;  // FNV-1a: Fowler, Noll and Vo's offset and prime.
  for (const char letter : sensor_name) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001B3ULL;
  }
  const auto words = RandomWords(seed, RandomUse::kSensorKey, static_cast<std::uint32_t>(hash),
                                 static_cast<std::uint32_t>(hash >> 32U));
  return std::uint64_t{words[0]} << 32U | words[1];
}

void CheckDetectorSpec(const DetectorSpec& spec) {
  DetectorSpec copy = spec;  // Descriptions take mutable values because the reader fills them.
  ErrorList errors;
  SpecChecker checker("", errors);
  DescribeRange(checker, copy);
  checker.Required("plausibility", copy.plausibility, "");
  checker.Required("beam", copy.beam, "");
  checker.Required("receiver", copy.receiver, "");
  checker.Required("cover", copy.cover, "");
  checker.Required("velocity", copy.velocity, "");
  checker.Required("weather", copy.weather, "");
  errors.ThrowIfAny();
}

bool HasMirrors(const ScenarioSpec& spec) {
  std::vector<ObjectType> vehicles;
  for (const TrainVehicleSpec& vehicle : spec.vehicle.consist) vehicles.push_back(vehicle.type);
  for (const TrainSpec& train : spec.world.trains) {
    for (const TrainVehicleSpec& vehicle : train.vehicles) vehicles.push_back(vehicle.type);
  }
  return std::ranges::any_of(spec.materials, [&](const Material& material) {
    const auto is_of_it = [&](const ObjectSpec& object) {
      return object.material == material.name ||
             (!object.material && MayHaveMaterial(object.type, material.name)) ||
             std::ranges::find(object.parts, material.name, &MeshPartSpec::material) !=
                 object.parts.end();
    };
    const auto is_of_vehicle = [&](const ObjectType& type) {
      return MayHaveMaterial(type, material.name);
    };
    return material.height_rms_um &&
           (IsRailMaterial(material.name) || IsWagonMaterial(material.name) ||
            (!spec.world.structures.empty() && IsStructureMaterial(material.name)) ||
            std::ranges::any_of(vehicles, is_of_vehicle) ||
            std::ranges::any_of(spec.world.objects, is_of_it));
  });
}

DetectorSpec DetectorSpecOf(const ScenarioSpec& spec,
                            const LidarSpec& lidar,
                            const EffectSet& effects) {
  return {.seed = SensorSeed(spec.seed, lidar.name),
          .air_seed = spec.seed,
          .ground_seed = spec.world.seed,
          .has_mirrors = HasMirrors(spec),
          .range_min_m = lidar.range_min_m,
          .range_max_m = lidar.range_max_m,
          .effects = effects,
          .plausibility = lidar.plausibility,
          .beam = lidar.beam,
          .receiver = lidar.receiver,
          .cover = lidar.cover,
          .velocity = lidar.velocity,
          .weather = spec.weather};
}

}  // namespace railcast
