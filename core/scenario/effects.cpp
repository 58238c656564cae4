#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/text.h"
#include "core/detect/detector/effect_table.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/objects/mesh_object.h"
#include "core/scenario/descriptions.h"
#include "core/scenario/json_text.h"
#include "core/scenario/shared_keys.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// The archive that checks (descriptions.h): holds the numbers of a struct that was made in C++
/// against the rules of its description. A fault's place is a JSON pointer:
/// "/beam/wavelength_nm: must be 905 or 1550 (got 1064)".
class SpecChecker final : public Archive {
 public:
  SpecChecker(std::string pointer, ErrorList& errors)
      : pointer_(std::move(pointer)), errors_(errors) {}

  void Ensure(std::initializer_list<std::string_view> keys,
              bool holds,
              std::string_view rule) override {
    const auto is_sound = [&](std::string_view key) { return sound_.contains(std::string(key)); };
    if (holds || !std::ranges::all_of(keys, is_sound)) return;
    const std::string first(*keys.begin());
    errors_.Add({pointer_ + PointerStep(first), std::string(rule), sound_.at(first)});
  }

  // For files only.
  void Preset(std::string_view, std::optional<std::string>&, KeyDoc, const FilePreset&) override {}
  void Types(std::string_view, std::vector<ModelSpec>&, KeyDoc) override {}
  void Switches(std::string_view,
                std::map<std::string, bool>&,
                KeyDoc,
                const std::vector<std::string>&) override {}

 private:
  void Visit(const Key& key, const ValueRef& value) override {
    const std::string place = pointer_ + PointerStep(key.name);
    const std::size_t num_faults = errors_.faults().size();
    CheckValue(place, value, key.rule);
    if (errors_.faults().size() == num_faults) sound_[std::string(key.name)] = TextOf(value);
  }

  [[nodiscard]] static std::string TextOf(const ValueRef& value) {
    switch (value.type->kind) {
      case ValueType::Kind::kNumber:
        return NumberText(*static_cast<const double*>(value.place));
      case ValueType::Kind::kWhole:
        return NumberText(value.type->whole(value.place));
      case ValueType::Kind::kOptional:
        if (value.type->size(value.place) == 0) return "";
        return TextOf({value.type->at(value.place, 0), value.type->of()});
      default:
        return "";
    }
  }

  void CheckValue(const std::string& place, const ValueRef& value, const RuleRef& rule) {
    const ValueType& type = *value.type;
    switch (type.kind) {
      case ValueType::Kind::kOptional:
        if (type.size(value.place) > 0) {
          CheckValue(place, {type.at(value.place, 0), type.of()}, rule);
        }
        break;
      case ValueType::Kind::kArray:
        for (std::size_t i = 0; i < type.size(value.place); ++i) {
          CheckValue(place + "/" + std::to_string(i), {type.at(value.place, i), type.of()}, rule);
        }
        break;
      case ValueType::Kind::kStruct: {
        SpecChecker checker(place, errors_);
        type.describe(checker, value.place);
        break;
      }
      case ValueType::Kind::kNumber:
        CheckNumber(place, *static_cast<const double*>(value.place), rule);
        break;
      case ValueType::Kind::kWhole:
        CheckNumber(place, static_cast<double>(type.whole(value.place)), rule);
        break;
      default:
        break;  // The specs of a detector have no lists and no texts.
    }
  }

  void CheckNumber(const std::string& place, double number, const RuleRef& rule) {
    std::optional<std::string> broken;
    if (const auto* const limits = rule.As<Limits>()) broken = Broken(*limits, number);
    if (const auto* const choices = rule.As<NumberChoices>()) {
      broken = Broken(*choices, static_cast<int>(number));
    }
    if (broken) errors_.Add({place, *broken, NumberText(number)});
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
  checker.Required("plausibility", copy.plausibility, "Which checks of plausibility there are.");
  checker.Required("beam", copy.beam, "What the beam is like.");
  checker.Required("receiver", copy.receiver, "What the receiver is like.");
  checker.Required("cover", copy.cover, "What is on the window.");
  checker.Required("velocity", copy.velocity, "How velocities are measured.");
  checker.Required("weather", copy.weather, "The weather.");
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
          .has_texture = std::ranges::any_of(
              spec.materials, [](const Material& material) { return material.texture > 0.0; }),
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
